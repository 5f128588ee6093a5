//! Closed forms with which the tests compare.

/// Cantilever of height D, length L and unit thickness in plane stress, whose end at x = L bears the shear force P
/// with a parabolic distribution; z is 0 on its middle line.
///
/// Source: Timoshenko & Goodier (1970), Theory of Elasticity, 3rd ed., §21.
#[derive(Debug, Clone, Copy)]
pub struct Cantilever {
    pub length: f64,
    pub height: f64,
    pub young: f64,
    pub poisson: f64,
    pub force: f64,
}

impl Cantilever {
    pub fn inertia(&self) -> f64 {
        self.height.powi(3) / 12.0
    }

    pub fn displacement(&self, [x, _, z]: [f64; 3]) -> [f64; 3] {
        let Self { length: l, height: d, young, poisson: nu, force } = *self;
        let factor = force / (6.0 * young * self.inertia());
        let along = z * ((6.0 * l - 3.0 * x) * x + (2.0 + nu) * (z * z - d * d / 4.0));
        let across =
            3.0 * nu * z * z * (l - x) + (4.0 + 5.0 * nu) * d * d * x / 4.0 + (3.0 * l - x) * x * x;
        [-factor * along, 0.0, factor * across]
    }

    /// Stresses xx, yy, zz, yz, zx, xy.
    pub fn stress(&self, at: [f64; 3]) -> [f64; 6] {
        let bending = -self.force * (self.length - at[0]) * at[2] / self.inertia();
        [bending, 0.0, 0.0, 0.0, self.end_traction(at)[2], 0.0]
    }

    /// Traction on the loaded end.
    pub fn end_traction(&self, [_, _, z]: [f64; 3]) -> [f64; 3] {
        let shear = self.force / (2.0 * self.inertia()) * (self.height * self.height / 4.0 - z * z);
        [0.0, 0.0, shear]
    }
}

/// Radial displacement per pressure inside a long tube of radii a and b whose ends are held, at its inner surface.
///
/// Source: Timoshenko & Goodier (1970), Theory of Elasticity, 3rd ed., §28.
pub fn widening_of_tube(a: f64, b: f64, young: f64, poisson: f64) -> f64 {
    let factor = (1.0 + poisson) / young * a * a / (b * b - a * a);
    factor * ((1.0 - 2.0 * poisson) * a + b * b / a)
}

/// The field u = (sin x cos z, cos x sin 2z) in plane strain with the body force that balances it, λ and µ being Lamé's
/// constants.
pub mod waves {
    pub fn displacement([x, _, z]: [f64; 3]) -> [f64; 3] {
        [x.sin() * z.cos(), 0.0, x.cos() * (2.0 * z).sin()]
    }

    pub fn gradient([x, _, z]: [f64; 3]) -> [[f64; 3]; 3] {
        let double = (2.0 * z).sin();
        [
            [x.cos() * z.cos(), 0.0, -x.sin() * z.sin()],
            [0.0; 3],
            [-x.sin() * double, 0.0, 2.0 * x.cos() * (2.0 * z).cos()],
        ]
    }

    /// b = −(λ + µ) ∇(∇·u) − µ ∇²u.
    pub fn body_force([x, _, z]: [f64; 3], lambda: f64, mu: f64) -> [f64; 3] {
        let double = 2.0 * z;
        // ∇·u = cos x cos z + 2 cos x cos 2z.
        let dilatation = [
            -x.sin() * z.cos() - 2.0 * x.sin() * double.cos(),
            -x.cos() * z.sin() - 4.0 * x.cos() * double.sin(),
        ];
        let laplacian = [-2.0 * x.sin() * z.cos(), -5.0 * x.cos() * double.sin()];
        let part = |a: usize| -(lambda + mu) * dilatation[a] - mu * laplacian[a];
        [part(0), 0.0, part(1)]
    }
}

/// The field of [`waves`] as radial and axial displacements: its body force in an axisymmetric body.
pub fn ring_waves_body_force([r, _, z]: [f64; 3], lambda: f64, mu: f64) -> [f64; 3] {
    let (s, c, double) = (r.sin(), r.cos(), 2.0 * z);
    // Derivative of sin(r)/r.
    let mean_slope = (r * c - s) / (r * r);
    // ∇·u = cos z (cos r + sin r / r) + 2 cos r cos 2z.
    let dilatation = [
        z.cos() * (mean_slope - s) - 2.0 * s * double.cos(),
        -z.sin() * (c + s / r) - 4.0 * c * double.sin(),
    ];
    // ∇²u_r − u_r/r² and ∇²u_z.
    let laplacian = [z.cos() * (mean_slope - 2.0 * s), -double.sin() * (5.0 * c + s / r)];
    let part = |a: usize| -(lambda + mu) * dilatation[a] - mu * laplacian[a];
    [part(0), 0.0, part(1)]
}
