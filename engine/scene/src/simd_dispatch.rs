//! Code compiled for several instruction levels and selected at run time. No level has instructions that round differently
//! (nothing is fused), so all give the same bits.

#![cfg_attr(
    target_arch = "x86_64",
    expect(
        unsafe_code,
        reason = "calling a function compiled for instructions that a check has found needs it"
    )
)]

/// Work on many numbers side by side, in loops that become vector instructions.
///
/// A trait, not a closure: code that is not `#[inline(always)]` does not use the instructions of the function around it,
/// and closures cannot be made so.
pub trait SimdKernel {
    /// The result.
    type Output;

    /// Runs the work; to be marked `#[inline(always)]`, like every costly function that it calls.
    fn run(self) -> Self::Output;
}

/// An instruction level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SimdLevel {
    /// The baseline of the architecture; SSE2 on x86-64.
    Portable,
    /// 256 bits.
    #[cfg(target_arch = "x86_64")]
    Avx2(CpuFeatureProof),
    /// 512 bits; F, VL, DQ and BW.
    #[cfg(target_arch = "x86_64")]
    Avx512(CpuFeatureProof),
}

/// Proof that the machine has a level's instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CpuFeatureProof(());

impl SimdLevel {
    /// Every level that this machine has, the best last.
    #[cfg(target_arch = "x86_64")]
    pub fn available() -> impl Iterator<Item = Self> {
        let avx2 = is_x86_feature_detected!("avx2");
        let avx512 = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512bw");
        let levels = [
            Some(Self::Portable),
            avx2.then_some(Self::Avx2(CpuFeatureProof(()))),
            avx512.then_some(Self::Avx512(CpuFeatureProof(()))),
        ];
        levels.into_iter().flatten()
    }

    /// Every level that this machine has, the best last.
    #[cfg(not(target_arch = "x86_64"))]
    pub fn available() -> impl Iterator<Item = Self> {
        std::iter::once(Self::Portable)
    }

    /// The best level that this machine has.
    #[inline]
    pub fn best_available() -> Self {
        static BEST: std::sync::OnceLock<SimdLevel> = std::sync::OnceLock::new();
        *BEST.get_or_init(|| Self::available().last().unwrap_or(Self::Portable))
    }

    /// Runs the work with the instructions of this level.
    #[inline]
    pub fn run<K: SimdKernel>(self, work: K) -> K::Output {
        match self {
            Self::Portable => work.run(),
            // SAFETY: `CpuFeatureProof` is made by `available` alone, after it found AVX2.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => unsafe { run_avx2(work) },
            // SAFETY: `CpuFeatureProof` is made by `available` alone, after it found AVX-512 F, VL, DQ and BW.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(_) => unsafe { run_avx512(work) },
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn run_avx2<K: SimdKernel>(work: K) -> K::Output {
    work.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw")]
fn run_avx512<K: SimdKernel>(work: K) -> K::Output {
    work.run()
}
