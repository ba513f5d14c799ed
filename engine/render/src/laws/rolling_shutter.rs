//! Rolling shutter: rows that are exposed one after another.

use super::{RenderLaw, RenderStage, Shutter};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues};

pub(super) const LAW: RenderLaw = RenderLaw {
    info: LawInfo {
        id: "rolling_shutter",
        version: 1,
        name: "rolling shutter",
        equation: "row v of h is taken (h - 1 - v) line_s (s) before the picture's time; camera and things move evenly from \
                   where they were a control step ago. A thing that moves through the image by s px/s is sheared by s line_s px \
                   a row",
        source: "M. Meingast, C. Geyer, S. Sastry, Geometric models of rolling-shutter cameras, OMNIVIS (2005); row V4 of \
                 measured data",
        engine: EngineKind::Render,
        acts_on: "agent",
        params: &[ParamInfo {
            name: "line_s",
            unit: "s",
            default: 0.0,
            low: 0.0,
            high: 1e-2,
            plausible: [1e-5, 3e-5],
        }],
        regimes: &[LawRegime::MovingImage],
        probes: &[&[("line_s", 2e-05)]],
        rivals: &["time_offset", "camera_roll"],
        separating_experiment: "look at an upright edge at rest and while the camera turns: only rolling rows shear it, and the \
                                other way round when it turns the other way; a time offset moves all rows alike",
    },
    effect: RenderStage::Shutter(apply),
};

fn apply(values: LawValues<'_>, shutter: &mut Shutter) {
    shutter.line_s += values.get_f32("line_s");
}
