//! Bar charts in one SVG.

use std::fmt::Write;

/// Labels and values.
pub(crate) type Bars = Vec<(String, f64)>;

/// Of a narrow chart, px.
const WIDTH: f64 = 360.0;
const HEIGHT: f64 = 200.0;
/// Narrow charts in a row.
const COLUMNS: usize = 3;
const INK: &str = "#4a6fa5";

/// Charts below each other.
#[derive(Clone, Debug, Default)]
pub(crate) struct Plots {
    narrow: Vec<(String, Bars)>,
    wide: Vec<(String, Bars)>,
}

impl Plots {
    /// A chart with upright labels, three in a row.
    pub(crate) fn add(&mut self, title: &str, bars: Bars) {
        self.narrow.push((title.to_owned(), bars));
    }

    /// A chart over the full width whose labels are slanted.
    pub(crate) fn add_wide(&mut self, title: &str, bars: Bars) {
        self.wide.push((title.to_owned(), bars));
    }

    pub(crate) fn svg(&self) -> String {
        let rows = self.narrow.len().div_ceil(COLUMNS);
        let width = WIDTH * COLUMNS as f64;
        let wide_height = HEIGHT + 90.0;
        let height = rows as f64 * HEIGHT + self.wide.len() as f64 * wide_height;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"sans-serif\" font-size=\"10\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
        );
        for (k, (title, bars)) in self.narrow.iter().enumerate() {
            let corner = [(k % COLUMNS) as f64 * WIDTH, (k / COLUMNS) as f64 * HEIGHT];
            chart(&mut svg, title, bars, corner, [WIDTH, HEIGHT - 40.0], false);
        }
        for (k, (title, bars)) in self.wide.iter().enumerate() {
            let corner = [0.0, rows as f64 * HEIGHT + k as f64 * wide_height];
            chart(&mut svg, title, bars, corner, [width, HEIGHT - 40.0], true);
        }
        svg.push_str("</svg>\n");
        svg
    }
}

fn chart(
    svg: &mut String,
    title: &str,
    bars: &Bars,
    [x, y]: [f64; 2],
    [width, height]: [f64; 2],
    slanted: bool,
) {
    let most = bars.iter().map(|(_, value)| *value).fold(1.0, f64::max);
    let (left, top) = (x + 34.0, y + 26.0);
    let floor = top + height - 26.0;
    let pitch = (width - 50.0) / bars.len().max(1) as f64;
    let mut put = |line: std::fmt::Arguments<'_>| {
        // Writing to a String cannot fail.
        let _ = svg.write_fmt(line);
    };
    put(format_args!(
        "<text x=\"{left:.1}\" y=\"{:.1}\" font-size=\"12\">{title}</text>\n",
        y + 16.0
    ));
    put(format_args!(
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{most}</text>\n",
        left - 4.0,
        top + 8.0
    ));
    // Not every label where bars are narrow.
    let each = if slanted {
        1
    } else {
        (18.0 / pitch).ceil().max(1.0) as usize
    };
    for (k, (label, value)) in bars.iter().enumerate() {
        let high = value / most * (floor - top);
        let at = left + k as f64 * pitch;
        put(format_args!(
            "<rect x=\"{at:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{high:.1}\" fill=\"{INK}\"/>\n",
            floor - high,
            pitch * 0.86
        ));
        let middle = at + 0.43 * pitch;
        if slanted {
            put(format_args!(
                "<text transform=\"translate({middle:.1},{:.1}) rotate(-50)\" text-anchor=\"end\">{label}</text>\n",
                floor + 12.0
            ));
        } else if k % each == 0 {
            put(format_args!(
                "<text x=\"{middle:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{label}</text>\n",
                floor + 12.0
            ));
        }
    }
    put(format_args!(
        "<line x1=\"{left:.1}\" y1=\"{floor:.1}\" x2=\"{:.1}\" y2=\"{floor:.1}\" stroke=\"#333\"/>\n",
        x + width - 12.0
    ));
}
