//! Spectra of short responses at any frequencies.

use realfft::num_complex::Complex;
use std::f64::consts::TAU;

/// Returns the modulus, by operations that give equal bits everywhere.
pub(super) fn modulus(value: Complex<f32>) -> f32 {
    value.norm_sqr().sqrt()
}

/// Complex exponentials at some frequencies, sample by sample.
pub(super) struct ComplexExponentials {
    /// Shape (sample, frequency), flat.
    cosine: Vec<f32>,
    sine: Vec<f32>,
    count: usize,
}

impl ComplexExponentials {
    /// Exponentials for responses of up to `samples` at `rate_hz`.
    pub(super) fn new(frequencies_hz: &[f64], rate_hz: f64, samples: usize) -> Self {
        let count = frequencies_hz.len();
        let (mut cosine, mut sine) = (
            Vec::with_capacity(samples * count),
            Vec::with_capacity(samples * count),
        );
        for n in 0..samples {
            for frequency_hz in frequencies_hz {
                let turns = frequency_hz / rate_hz * n as f64;
                let (s, c) = libm::sincos(TAU * (turns - turns.floor()));
                cosine.push(c as f32);
                sine.push(s as f32);
            }
        }
        Self {
            cosine,
            sine,
            count,
        }
    }

    /// Returns the spectrum of a response whose sample 0 is at time 0. Shape (frequency,).
    pub(super) fn spectrum(&self, response: &[f32]) -> Vec<Complex<f32>> {
        let (mut re, mut im) = (vec![0.0_f32; self.count], vec![0.0_f32; self.count]);
        let rows = self.cosine.chunks_exact(self.count);
        let rows = rows.zip(self.sine.chunks_exact(self.count));
        for (x, (cosine, sine)) in response.iter().zip(rows) {
            for ((re, im), (c, s)) in re.iter_mut().zip(&mut im).zip(cosine.iter().zip(sine)) {
                *re += x * c;
                *im -= x * s;
            }
        }
        let both = re.into_iter().zip(im);
        both.map(|(re, im)| Complex::new(re, im)).collect()
    }
}
