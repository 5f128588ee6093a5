//! Small-strain J₂ plasticity with isotropic hardening, linear and saturating, and linear kinematic hardening.
//!
//! With the deviator s of stress, the back stress β, `ξ = s − β` and the accumulated plastic strain p:
//!
//! - Yield: `‖ξ‖ ≤ √⅔ Y(p)` (R. von Mises 1913), `Y = σ_y + H_i p + (σ_∞ − σ_y)(1 − e^(−δp))` (E. Voce 1948).
//! - Flow: `ε̇ₚ = γ̇ n`, `n = ξ/‖ξ‖`, `ṗ = √⅔ γ̇`.
//! - Hardening: `β = ⅔ H_k a`, `ȧ = ε̇ₚ` (W. Prager 1956, doi 10.1115/1.4011389, as an energy `⅓ H_k a:a`).
//! - Elasticity: `σ = 3K (tr ε/3 − ε_T) 1 + 2G dev(ε − εₚ)`, `ε_T = α(T)(T − T_ref)`.
//!
//! A step is the radial return of M. L. Wilkins 1964 with the consistent tangent of J. C. Simo and R. L. Taylor 1985
//! (doi 10.1016/0045-7825(85)90070-2). If hardening is linear, the return is one division; saturation takes Newton's
//! method. It is exact for temperature-dependent constants, because all of them are those of the step's end.

use std::sync::Arc;

use super::large_strain::{Deviator, LargeStrainLaw, Plastic};
use super::law::{Deformation, FlowLaw, Need, Response};
use super::neo_hookean::moduli;
use super::overstress::{Overstress, Parted};
use super::{
    Elasticity, PlasticHistory, Relaxation, Saturating, Saturation, Thermoelastic, Yielding,
    law_of_parts,
};
use crate::laws::Property;

law_of_parts! {
    /// Keys of J₂ plasticity.
    ElastoplasticLaw { elasticity: Elasticity, yielding: Yielding, saturating: Saturating }
}

impl Deformation for ElastoplasticLaw {
    fn elasticity(&self) -> &Elasticity {
        &self.elasticity
    }

    fn needs(&self) -> Vec<Need> {
        let yields =
            Need { key: "yield_stress", why: "", allowed: "a positive number or table (Pa)" };
        [yields].into_iter().chain(Elasticity::needs("an elastoplastic material deforms")).collect()
    }

    fn yields(&self) -> bool {
        true
    }

    fn saturation(&self) -> Option<Saturation> {
        self.saturating.hardening
    }

    fn large_strain(&self, temperature: f64) -> Option<LargeStrainLaw> {
        let [bulk, shear] = moduli(&self.elasticity, temperature)?;
        let value = |property: &Option<Property>| Some(property.as_ref()?.value(temperature));
        let yield_stress = value(&self.yielding.yield_stress)?;
        let hardening = value(&self.yielding.isotropic_hardening).unwrap_or(0.0);
        let kinematic = value(&self.yielding.kinematic_hardening).unwrap_or(0.0);
        let none = Saturation { saturation: yield_stress, rate: 0.0 };
        let Saturation { saturation, rate } = self.saturation().unwrap_or(none);
        let plastic = Plastic { yield_stress, hardening, saturation, rate, kinematic };
        let deviator = Deviator::Plastic(plastic);
        (saturation >= yield_stress).then_some(LargeStrainLaw { bulk, shear, deviator })
    }

    fn flow_law(&self, stress_free_temperature: f64) -> Arc<dyn FlowLaw> {
        let never = f64::INFINITY;
        let linear =
            Elastoplastic::of(&self.elasticity, &self.yielding, never, stress_free_temperature);
        Arc::new(Elastoplastic { saturating: self.saturation(), ..linear })
    }
}

/// A constant as a function of temperature [K].
pub type OfTemperature = Arc<dyn Fn(f64) -> f64 + Send + Sync>;

/// The function that is constant over temperature.
pub fn constant(value: f64) -> OfTemperature {
    Arc::new(move |_| value)
}

/// J₂ plasticity with constants as functions of temperature.
#[derive(Clone)]
pub struct Elastoplastic {
    /// Young's modulus E [Pa].
    pub young: OfTemperature,
    /// Poisson's ratio ν [1].
    pub poisson: OfTemperature,
    /// Mean coefficient of linear thermal expansion α from a temperature T₀ on [1/K].
    pub expansion: OfTemperature,
    /// T₀ [K].
    pub expansion_reference: f64,
    /// Initial yield stress σ_y [Pa]; infinite if the material never yields.
    pub yield_stress: OfTemperature,
    /// Isotropic hardening modulus H_i [Pa].
    pub isotropic: OfTemperature,
    /// Saturation of the yield stress; `None` if it hardens linearly.
    pub saturating: Option<Saturation>,
    /// Kinematic hardening modulus H_k [Pa].
    pub kinematic: OfTemperature,
    /// Temperature T_f without thermal strain [K].
    pub stress_free_temperature: f64,
}

/// Constants of the law at one temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointConstants {
    /// Bulk modulus K [Pa].
    pub bulk: f64,
    /// Shear modulus G [Pa].
    pub shear: f64,
    /// Thermal strain ε_T [1].
    pub thermal_strain: f64,
    /// Initial yield stress σ_y [Pa].
    pub yield_stress: f64,
    /// Hardening moduli H_i and H_k [Pa].
    pub isotropic: f64,
    pub kinematic: f64,
    /// Growth of the yield stress that saturates.
    pub growth: Growth,
    /// Overstress of viscous flow beyond the yield surface.
    pub overstress: Overstress,
    /// Reduced time of the step, in which moduli relax [s].
    pub reduced_time: f64,
}

/// Growth of a yield stress that saturates, `R (1 − e^(−δp))` at an accumulated plastic strain p.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Growth {
    /// R = σ_∞ − σ_y [Pa]; 0 without saturation.
    pub range: f64,
    /// δ [1].
    pub rate: f64,
}

/// Change of a point's stress: `dσ = K dθ 1 + A de + B n (n:de)` with the change θ of volume and e of shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointTangent {
    /// K [Pa].
    pub bulk: f64,
    /// A and B [Pa].
    pub all: f64,
    pub along: f64,
    /// n, in stress notation: shears once.
    pub direction: [f64; 6],
}

/// `√⅔`
const ROOT: f64 = 0.816_496_580_927_726;

/// Upper limit of iterations, above the number that any root needs.
const MOST_ITERATIONS: usize = 100;

/// Scalar product of two symmetric tensors given as xx, yy, zz, xy, yz, xz, shears once.
fn inner(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2.0 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5])
}

/// Norm `√(a:a)`, safe from overflow.
fn norm(a: &[f64; 6]) -> f64 {
    let largest = a.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    let scaled = a.map(|v| v / largest);
    largest * inner(&scaled, &scaled).sqrt()
}

/// Converts strain components to tensor components: engineering shears are halved.
fn tensor(strain: &[f64; 6]) -> [f64; 6] {
    std::array::from_fn(|i| if i < 3 { strain[i] } else { 0.5 * strain[i] })
}

impl Elastoplastic {
    /// Creates the law with these constants; `otherwise` is the yield stress [Pa] if the scene sets none.
    ///
    /// # Panics
    /// If constants of elasticity are missing; checked scenes with mechanics have them.
    pub fn of(
        elasticity: &Elasticity,
        yielding: &Yielding,
        otherwise: f64,
        stress_free_temperature: f64,
    ) -> Self {
        let given = |property: &Option<Property>| -> OfTemperature {
            let property = property.clone().expect("mechanics has its constants");
            Arc::new(move |temperature| property.value(temperature))
        };
        let or = |property: &Option<Property>, other: f64| match property {
            Some(_) => given(property),
            None => constant(other),
        };
        Self {
            young: given(&elasticity.young),
            poisson: given(&elasticity.poisson),
            expansion: given(&elasticity.expansion),
            expansion_reference: elasticity.expansion_reference.unwrap_or(stress_free_temperature),
            yield_stress: or(&yielding.yield_stress, otherwise),
            isotropic: or(&yielding.isotropic_hardening, 0.0),
            saturating: None,
            kinematic: or(&yielding.kinematic_hardening, 0.0),
            stress_free_temperature,
        }
    }

    /// Creates the law without yielding.
    pub fn elastic(law: &Thermoelastic, stress_free_temperature: f64) -> Self {
        Self {
            young: constant(law.young),
            poisson: constant(law.poisson),
            expansion: constant(law.expansion),
            expansion_reference: stress_free_temperature,
            yield_stress: constant(f64::INFINITY),
            isotropic: constant(0.0),
            saturating: None,
            kinematic: constant(0.0),
            stress_free_temperature,
        }
    }

    /// Returns the constants at a temperature [K]; `None` if they are invalid. Invalid are non-positive moduli, ν
    /// outside of −1 < ν < ½, a negative yield stress, softening (saturation below the yield stress, too), and NaN.
    pub fn at(&self, temperature: f64) -> Option<PointConstants> {
        let (young, poisson) = ((self.young)(temperature), (self.poisson)(temperature));
        let yield_stress = (self.yield_stress)(temperature);
        let constants = PointConstants {
            bulk: young / (3.0 * (1.0 - 2.0 * poisson)),
            shear: young / (2.0 * (1.0 + poisson)),
            thermal_strain: self.thermal_strain(temperature),
            yield_stress,
            isotropic: (self.isotropic)(temperature),
            kinematic: (self.kinematic)(temperature),
            growth: self.saturating.map_or(Growth::NONE, |own| Growth::from(own, yield_stress)),
            overstress: Overstress::NONE,
            reduced_time: 0.0,
        };
        constants.is_sensible().then_some(constants)
    }
}

impl Elastoplastic {
    /// `ε_T = α(T) (T − T₀) − α(T_f) (T_f − T₀)`
    fn thermal_strain(&self, temperature: f64) -> f64 {
        let free = self.stress_free_temperature;
        let from_reference = |t: f64| (self.expansion)(t) * (t - self.expansion_reference);
        if free == self.expansion_reference {
            return from_reference(temperature);
        }
        from_reference(temperature) - from_reference(free)
    }
}

impl Growth {
    /// No growth.
    pub const NONE: Self = Self { range: 0.0, rate: 1.0 };

    /// Growth from a yield stress [Pa].
    fn from(Saturation { saturation, rate }: Saturation, yield_stress: f64) -> Self {
        Self { range: saturation - yield_stress, rate }
    }

    /// Growth up to an accumulated plastic strain [Pa].
    fn at(&self, accumulated: f64) -> f64 {
        -self.range * (-self.rate * accumulated).exp_m1()
    }

    /// Slope of the growth by the plastic strain [Pa].
    fn slope(&self, accumulated: f64) -> f64 {
        self.range * self.rate * (-self.rate * accumulated).exp()
    }

    /// Flow γ that takes up an excess e [Pa] over the yield surface at an accumulated plastic strain p:
    /// `e = m γ + √⅔ R e^(−δp) (1 − e^(−√⅔ δγ))`, with a modulus m [Pa] of what is linear.
    ///
    /// The remainder of e is a convex, falling function of γ, so that Newton's method from γ = 0 rises to the root.
    fn part(&self, excess: f64, modulus: f64, accumulated: f64) -> Parted {
        let rest = Self { range: self.range * (-self.rate * accumulated).exp(), ..*self };
        let slope = |flow: f64| modulus + rest.slope(ROOT * flow) / 1.5;
        let mut flow = 0.0_f64;
        for _ in 0..MOST_ITERATIONS {
            let left = excess - modulus * flow - ROOT * rest.at(ROOT * flow);
            let change = left / slope(flow);
            // Rounding may reverse its sign at the root.
            if change.is_nan() || change <= 0.5 * f64::EPSILON * flow {
                break;
            }
            flow += change;
        }
        Parted { flow, overstress: 0.0, share: modulus / slope(flow) }
    }

    /// Work of the growth up to an accumulated plastic strain [J/m³].
    fn work(&self, accumulated: f64) -> f64 {
        self.range * accumulated - self.at(accumulated) / self.rate
    }
}

impl PointConstants {
    fn is_sensible(&self) -> bool {
        let moduli = [self.bulk, self.shear].iter().all(|m| m.is_finite() && *m > 0.0);
        let hardening = [self.isotropic, self.kinematic, self.growth.range];
        let hardening = hardening.iter().all(|h| h.is_finite() && *h >= 0.0);
        moduli && hardening && self.thermal_strain.is_finite() && self.yield_stress >= 0.0
    }

    /// `E/(1 − ν) = 18KG/(3K + 4G)`, the ratio of stress to strain for equibiaxial strain [Pa].
    pub fn biaxial_modulus(&self) -> f64 {
        18.0 * self.bulk * self.shear / (3.0 * self.bulk + 4.0 * self.shear)
    }

    /// Returns the tangent without yielding.
    pub fn elastic_tangent(&self) -> PointTangent {
        PointTangent { bulk: self.bulk, all: 2.0 * self.shear, along: 0.0, direction: [0.0; 6] }
    }

    /// Returns the stress of a change of shape [Pa], after the return to the yield surface.
    ///
    /// `shape` is the strain minus a third of the elastic volume change and minus the thermal strain in each direction,
    /// with engineering shears. It is a deviator if elements use the volume change at the point itself. The remainder
    /// of a projected volume change yields with the rest.
    pub fn return_to_yield(
        &self,
        shape: &[f64; 6],
        old: &PlasticHistory,
        new: &mut PlasticHistory,
    ) -> ([f64; 6], PointTangent) {
        *new = *old;
        let mut tangent = self.elastic_tangent();
        let (e, plastic) = (tensor(shape), tensor(&old.plastic_strain));
        let trial: [f64; 6] = std::array::from_fn(|i| 2.0 * self.shear * (e[i] - plastic[i]));
        let back = self.back_stress(&old.back_strain);
        let xi: [f64; 6] = std::array::from_fn(|i| trial[i] - back[i]);
        let size = norm(&xi);
        let excess = size - self.radius(old.accumulated);
        // Not `excess <= 0`, so that NaN propagates.
        if excess.is_nan() || excess <= 0.0 || !size.is_finite() {
            return (trial, tangent);
        }
        let modulus = 2.0 * self.shear + (self.isotropic + self.kinematic) / 1.5;
        let Parted { flow, overstress, share } = match self.growth {
            Growth::NONE => self.overstress.part(excess, modulus),
            growth => growth.part(excess, modulus, old.accumulated),
        };
        let direction = xi.map(|x| x / size);
        for (i, n) in direction.iter().enumerate() {
            let change = flow * n * if i < 3 { 1.0 } else { 2.0 };
            new.plastic_strain[i] += change;
            new.back_strain[i] += change;
        }
        new.accumulated += ROOT * flow;
        new.dissipated += (self.yield_stress * ROOT + overstress) * flow;
        // From the flow surface, not from the trial, which may be far beyond it.
        let radius = self.radius(new.accumulated) + overstress;
        let back = self.back_stress(&new.back_strain);
        let stress = std::array::from_fn(|i| back[i] + radius * direction[i]);
        let kept = 1.0 - 2.0 * self.shear * flow / size;
        tangent.all *= kept;
        tangent.along = 2.0 * self.shear * (1.0 - kept - 2.0 * self.shear * share / modulus);
        tangent.direction = direction;
        (stress, tangent)
    }

    /// Radius of the yield surface at an accumulated plastic strain, `√⅔ Y(p)` [Pa].
    pub fn radius(&self, accumulated: f64) -> f64 {
        let linear = self.yield_stress + self.isotropic * accumulated;
        ROOT * (linear + self.growth.at(accumulated))
    }

    /// Distance of a stress [Pa] beyond the yield surface, `‖ξ‖ − √⅔ Y(p)` [Pa]; negative within it.
    pub fn beyond_yield(&self, stress: &[f64; 6], history: &PlasticHistory) -> f64 {
        let mean = (stress[0] + stress[1] + stress[2]) / 3.0;
        let back = self.back_stress(&history.back_strain);
        let xi = std::array::from_fn(|i| stress[i] - back[i] - if i < 3 { mean } else { 0.0 });
        norm(&xi) - self.radius(history.accumulated)
    }

    /// Plastic strain that would accumulate over the step at constant stress [Pa]; `None` for rate-independent flow.
    pub fn flow_at(&self, stress: &[f64; 6], history: &PlasticHistory) -> Option<f64> {
        if self.overstress == Overstress::NONE {
            return None;
        }
        Some(ROOT * self.overstress.flow(self.beyond_yield(stress, history)))
    }

    /// Back stress β of a back strain [Pa].
    pub fn back_stress(&self, back_strain: &[f64; 6]) -> [f64; 6] {
        tensor(back_strain).map(|a| self.kinematic / 1.5 * a)
    }

    /// Energy stored by hardening per volume, `½ H_i p² + ⅓ H_k a:a` and the work of the growth [J/m³].
    pub fn hardening_energy(&self, history: &PlasticHistory) -> f64 {
        let back = tensor(&history.back_strain);
        0.5 * self.isotropic * history.accumulated.powi(2)
            + self.kinematic / 3.0 * inner(&back, &back)
            + self.growth.work(history.accumulated)
    }
}

impl PointTangent {
    /// Change of stress for a change of shape with engineering shears.
    #[inline]
    pub fn of_shape(&self, change: &[f64; 6]) -> [f64; 6] {
        let n = &self.direction;
        let along: f64 = self.along * (0..6).map(|i| n[i] * change[i]).sum::<f64>();
        std::array::from_fn(|i| self.all * change[i] * if i < 3 { 1.0 } else { 0.5 } + along * n[i])
    }

    /// Change of stress for a strain.
    pub fn of_strain(&self, strain: &[f64; 6]) -> [f64; 6] {
        let volume = strain[0] + strain[1] + strain[2];
        let mut shape = *strain;
        shape[..3].iter_mut().for_each(|e| *e -= volume / 3.0);
        let mut stress = self.of_shape(&shape);
        stress[..3].iter_mut().for_each(|s| *s += self.bulk * volume);
        stress
    }
}

impl FlowLaw for Elastoplastic {
    fn stress_free_temperature(&self) -> f64 {
        self.stress_free_temperature
    }

    fn over_step(&self, temperature: f64, _: f64) -> Option<PointConstants> {
        self.at(temperature)
    }
}

impl From<Elastoplastic> for Arc<dyn FlowLaw> {
    fn from(law: Elastoplastic) -> Self {
        Arc::new(law)
    }
}

/// Response with given constants; NaN without any.
pub(super) fn respond_at(
    (constants, relaxation): (Option<PointConstants>, Option<&Relaxation>),
    strain: &[f64; 6],
    old: &[f64],
    new: &mut [f64],
) -> Response {
    let Some(constants) = constants else {
        new.copy_from_slice(old);
        return Response { stress: [f64::NAN; 6], tangent: [[f64::NAN; 6]; 6], dissipation: 0.0 };
    };
    let volume = strain[0] + strain[1] + strain[2];
    let mut shape = *strain;
    shape[..3].iter_mut().for_each(|e| *e -= volume / 3.0);
    let dilatation = volume - 3.0 * constants.thermal_strain;
    let (mut stress, pressure, tangent) = match relaxation {
        Some(relaxation) => {
            let found = relaxation.respond(&constants, (&shape, dilatation), old, new);
            (found.stress, found.pressure, found.tangent)
        }
        None => {
            let mut after = PlasticHistory::default();
            let before = PlasticHistory::read(old);
            let (stress, tangent) = constants.return_to_yield(&shape, &before, &mut after);
            after.write(new);
            (stress, constants.bulk * dilatation, tangent)
        }
    };
    let dissipated = |history: &[f64]| PlasticHistory::read(history).dissipated;
    stress[..3].iter_mut().for_each(|s| *s += pressure);
    // Symmetric: columns equal rows.
    let rows = std::array::from_fn(|j| {
        tangent.of_strain(&std::array::from_fn(|i| f64::from(u8::from(i == j))))
    });
    Response { stress, tangent: rows, dissipation: dissipated(new) - dissipated(old) }
}

#[cfg(test)]
mod tests;
