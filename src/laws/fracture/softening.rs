//! Softening of the links of a lattice: a bilinear law of force over stretch.

/// Bilinear softening of a link of given length.
///
/// Up to the stretch S_t the link is elastic, to α₂ S_t its force falls to the part α₁ of the largest, to α₃ S_t to
/// zero. A. Asadollahi 2014, *Simulation of fracture of concrete using micropolar peridynamics*, thesis, University
/// of New Mexico, eq. 3.11 to 3.15.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Softening {
    /// Stretch at the strength S_t [1].
    pub onset: f64,
    /// Part α₁ of the largest force at the knee [1].
    pub share: f64,
    /// Stretch at the knee over S_t, α₂ [1].
    pub knee: f64,
    /// Stretch without force over S_t, α₃ [1].
    pub end: f64,
}

impl Softening {
    /// Damage ω of a link under a stretch ε never exceeded before, and its derivative dω/dε.
    pub fn damage(&self, stretch: f64) -> (f64, f64) {
        let Self { onset, share, knee, end } = *self;
        let ratio = stretch / onset;
        if ratio <= 1.0 {
            (0.0, 0.0)
        } else if ratio <= knee {
            let fall = (knee - share) / (knee - 1.0);
            (fall * (1.0 - 1.0 / ratio), fall / (ratio * stretch))
        } else if ratio < end {
            let fall = share / (end - knee);
            (1.0 - fall * (end / ratio - 1.0), fall * end / (ratio * stretch))
        } else {
            (1.0, 0.0)
        }
    }

    /// The stretch at which a damage ω is reached; α₃ S_t if broken.
    pub fn stretch_of(&self, damage: f64) -> f64 {
        let Self { onset, share, knee, end } = *self;
        let fall = (knee - share) / (knee - 1.0);
        let at_knee = fall * (1.0 - 1.0 / knee);
        let ratio = match damage <= at_knee {
            true => 1.0 / (1.0 - damage / fall),
            false => end / (1.0 + (1.0 - damage) * (end - knee) / share),
        };
        onset * ratio
    }

    /// Energy that growing damage dissipates, over that of the undamaged link at a stretch of one: `½ ∫ ε² dω` along the
    /// law. On each branch `ω = A − B/ε`, so that it is `½ Δω ε₀ ε₁`.
    pub fn dissipation(&self, [from, to]: [f64; 2]) -> f64 {
        let at_knee = self.damage(self.onset * self.knee).0;
        let branch = |from: f64, to: f64| {
            if to > from {
                0.5 * (to - from) * self.stretch_of(from) * self.stretch_of(to)
            } else {
                0.0
            }
        };
        branch(from, to.min(at_knee)) + branch(from.max(at_knee), to)
    }

    /// Energy that breaks a link, over that of the undamaged link at twice S_t²: `½[1 + (1 + α₁)(α₂ − 1) + α₁(α₃ −
    /// α₂)]`.
    pub fn energy(&self) -> f64 {
        let Self { share, knee, end, .. } = *self;
        0.5 * (1.0 + (1.0 + share) * (knee - 1.0) + share * (end - knee))
    }
}

/// Law of softening of all links, of any length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SofteningLaw {
    /// Stretches as the source has them: the energy of a crack grows with the length of links.
    Stretches {
        /// S_t [1].
        onset: f64,
        /// α₂ and α₃ [1].
        ends: [f64; 2],
        /// α₁ [1].
        share: f64,
    },
    /// Openings, a cohesive law: the energy of a crack is that of the material, whatever the length of links, as long
    /// as they store little of it up to their strength.
    Openings {
        /// Stress f_t at which links along it soften [Pa].
        strength: f64,
        /// Elongation w₂ and w₃ beyond that at the strength, at the knee and without force [m].
        ends: [f64; 2],
        /// α₁ [1].
        share: f64,
    },
}

impl SofteningLaw {
    /// Law of a link of given length [m] in a sheet of Young's modulus E [Pa], of a strength that is scattered by a
    /// factor: with openings `S_t = f_t/E` and `α_k = 1 + w_k/(S_t s)`.
    pub fn of_link(&self, length: f64, young: f64, factor: f64) -> Softening {
        match *self {
            Self::Stretches { onset, ends: [knee, end], share } => {
                Softening { onset: factor * onset, share, knee, end }
            }
            Self::Openings { strength, ends, share } => {
                let onset = factor * strength / young;
                let [knee, end] = ends.map(|opening| 1.0 + opening / (onset * length));
                Softening { onset, share, knee, end }
            }
        }
    }

    /// Area below a law over openings, `½ f_t (w₂ + α₁ w₃)` [J/m²]; `None` over stretches, whose area grows with the
    /// length of links.
    pub fn area(&self) -> Option<f64> {
        match *self {
            Self::Stretches { .. } => None,
            Self::Openings { strength, ends: [knee, end], share } => {
                Some(0.5 * strength * (knee + share * end))
            }
        }
    }

    /// Energy that a link of given length [m] stores up to its strength, over the area below a law over openings:
    /// `s f_t/(E (w₂ + α₁ w₃))`. Its break takes both.
    pub fn stored_share(&self, length: f64, young: f64) -> Option<f64> {
        match *self {
            Self::Stretches { .. } => None,
            Self::Openings { strength, .. } => {
                Some(0.5 * length * strength * strength / young / self.area()?)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Softening = Softening { onset: 1.5e-4, share: 0.13, knee: 20.0, end: 415.0 };

    #[test]
    fn stretch_and_damage_are_inverse() {
        for ratio in [1.0, 1.3, 7.0, 19.9, 20.1, 200.0, 415.0] {
            let stretch = ratio * LAW.onset;
            let found = LAW.stretch_of(LAW.damage(stretch).0);
            assert!((found / stretch - 1.0).abs() < 1e-9, "{ratio}: {found}");
        }
    }

    /// The energy of a link of any length is the area below its law and what it stores up to its strength.
    #[test]
    fn links_take_the_area_and_what_they_store() {
        let law = SofteningLaw::Openings { strength: 4.5e6, ends: [9.05e-6, 197e-6], share: 0.13 };
        for length in [1e-4, 6e-3, 10.0] {
            let own = law.of_link(length, 30e9, 1.0);
            let taken = own.energy() * 30e9 * length * own.onset * own.onset;
            let stored = law.stored_share(length, 30e9).unwrap();
            let wanted = law.area().unwrap() * (1.0 + stored);
            assert!((taken / wanted - 1.0).abs() < 1e-12, "{length}: {taken} {wanted}");
        }
    }

    #[test]
    fn dissipation_adds_up_to_the_energy_of_a_link() {
        let whole = LAW.energy() * LAW.onset * LAW.onset;
        let near = |found: f64, wanted: f64| (found / wanted - 1.0).abs() < 1e-12;
        assert!(near(LAW.dissipation([0.0, 1.0]), whole));
        // Steps across the knee, too.
        let ends = [0.0, 0.3, 0.9, 0.97, 0.995, 1.0];
        let sum: f64 = ends.windows(2).map(|pair| LAW.dissipation([pair[0], pair[1]])).sum();
        assert!(near(sum, whole), "{sum} {whole}");
        assert_eq!(LAW.dissipation([0.5, 0.5]), 0.0);
    }
}
