//! Numbers in sentences.

/// A number with three significant digits, without an exponent where it is short.
pub(crate) fn format_number(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return if value > 0.0 {
            "infinity".to_owned()
        } else {
            "-infinity".to_owned()
        };
    }
    let magnitude = value.abs().log10().floor();
    if !(-4.0..6.0).contains(&magnitude) {
        return format!("{value:.2e}");
    }
    let digits = (2.0 - magnitude).max(0.0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// A share in percent, with a digit after the point under 10.
pub(crate) fn format_percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent.abs() < 10.0 {
        format!("{percent:.1} %")
    } else {
        format!("{percent:.0} %")
    }
}

/// `a`, `a and b`, `a, b and c`.
pub(crate) fn format_list(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [rest @ .., last] => format!("{} and {last}", rest.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        let cases = [
            (0.0, "0"),
            (0.4712, "0.471"),
            (1.5, "1.5"),
            (1234.4, "1234"),
            (2.5e-7, "2.50e-7"),
            (-9.806_65, "-9.81"),
        ];
        for (value, text) in cases {
            assert_eq!(format_number(value), text);
        }
        assert_eq!(format_percent(0.034), "3.4 %");
        assert_eq!(
            format_list(&["a".into(), "b".into(), "c".into()]),
            "a, b and c"
        );
    }
}
