//! Eigenvectors of dense symmetric matrices, on the calling thread.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{
    ComputeEigenvectors, SelfAdjointEvdParams, self_adjoint_evd, self_adjoint_evd_scratch,
};
use faer::{Auto, Mat, Par};

/// Eigenvectors of a symmetric matrix by ascending eigenvalue.
pub fn eigenvectors(symmetric: &Mat<f64>) -> Mat<f64> {
    let m = symmetric.nrows();
    // The divide-and-conquer method that faer uses above 128 rows left residuals of 1e-3 of the
    // largest eigenvalue on uniform meshes; its QR method stays at rounding.
    let mut parameters: SelfAdjointEvdParams = Auto::<f64>::auto();
    parameters.recursion_threshold = usize::MAX;
    let scratch =
        self_adjoint_evd_scratch::<f64>(m, ComputeEigenvectors::Yes, Par::Seq, parameters.into());
    let mut vectors = Mat::zeros(m, m);
    let mut values = Diag::zeros(m);
    self_adjoint_evd(
        symmetric.as_ref(),
        values.as_mut(),
        Some(vectors.as_mut()),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        parameters.into(),
    )
    .expect("the eigenproblem of a finite symmetric matrix converges");
    vectors
}
