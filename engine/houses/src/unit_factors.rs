//! Colours and other factors of files: from 0 to 1.

use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// Brings factors into 0 to 1; where one lay outside, the report says so.
pub(crate) fn unit_factors<const N: usize>(
    factors: [f64; N],
    at: &FileLocation,
    report: &mut LoadReport,
) -> [f32; N] {
    let wrong = factors.iter().find(|x| !(0.0..=1.0).contains(*x));
    if let Some(wrong) = wrong {
        let damage = WarningKind::BadField {
            found: format!("{wrong}, which was brought into it"),
            expected: "0 to 1".to_owned(),
        };
        report.warn(at.clone(), damage);
    }
    factors.map(|x| x.clamp(0.0, 1.0) as f32)
}
