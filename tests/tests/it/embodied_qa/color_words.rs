//! Plain colour words, by hue, saturation and value.

/// Plain words that a pixel may have, from its hue, saturation and value.
pub(super) fn words_of(rgb: [f32; 3]) -> Vec<&'static str> {
    let [r, g, b] = rgb.map(|c| {
        let c = c.clamp(0.0, 1.0);
        if c <= 0.003_130_8 {
            12.92 * c
        } else {
            1.055 * c.powf(1.0 / 2.4) - 0.055
        }
    });
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    let span = most - least;
    let mut words = Vec::new();
    if span < 0.22 {
        words.extend(
            [
                ("black", 0.0..0.35),
                ("gray", 0.2..0.9),
                ("white", 0.7..1.1),
            ]
            .iter()
            .filter(|(_, range)| range.contains(&most))
            .map(|(word, _)| *word),
        );
    }
    if span > 0.04 {
        let hue = if most == r {
            ((g - b) / span).rem_euclid(6.0)
        } else if most == g {
            (b - r) / span + 2.0
        } else {
            (r - g) / span + 4.0
        };
        let degrees = 60.0 * hue;
        let ranges: [(&str, [f32; 2]); 9] = [
            ("red", [335.0, 385.0]),
            ("pink", [290.0, 385.0]),
            ("orange", [8.0, 45.0]),
            ("brown", [0.0, 60.0]),
            ("beige", [15.0, 65.0]),
            ("yellow", [35.0, 75.0]),
            ("green", [60.0, 185.0]),
            ("blue", [165.0, 265.0]),
            ("purple", [240.0, 335.0]),
        ];
        let fits = ranges.iter().filter(|(_, [low, high])| {
            (*low..*high).contains(&degrees) || (*low..*high).contains(&(degrees + 360.0))
        });
        words.extend(fits.map(|(word, _)| *word));
    }
    words
}
