//! Properties of program and machine on which the bits of results may depend.

use impinge::fmi;

/// Describes sources, build and processor.
pub fn environment() -> String {
    let build = if cfg!(debug_assertions) { "checked" } else { "release" };
    let system = std::env::consts::OS;
    format!("{}, {build}, {system}, {}", fmi::MARK, processor())
}

/// Describes the instructions among which products of matrices choose when they run.
#[cfg(target_arch = "x86_64")]
fn processor() -> String {
    let fused = is_x86_feature_detected!("fma");
    let [wide, wider] = [is_x86_feature_detected!("avx2"), is_x86_feature_detected!("avx512f")];
    format!("x86-64, fma {fused}, avx2 {wide}, avx512f {wider}")
}

#[cfg(not(target_arch = "x86_64"))]
fn processor() -> String {
    std::env::consts::ARCH.to_owned()
}
