//! Motion blur: light that is gathered while things move.

use super::{RenderLaw, RenderStage, Shutter};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues};

pub(super) const LAW: RenderLaw = RenderLaw {
    info: LawInfo {
        id: "motion_blur",
        version: 1,
        name: "motion blur",
        equation: "a pixel shows the mean light of exposure_s (s) before it is taken, from 16 moments in even steps; camera and \
                   things move evenly from where they were a control step ago. An edge that moves through the image by s px/s \
                   becomes a ramp of s exposure_s px. Colour only: depth and ids are those of the moment at which the pixel is \
                   taken",
        source: "M. Potmesil, I. Chakravarty, Modeling motion blur in computer-generated images, SIGGRAPH (1983); row V5 of \
                 measured data",
        engine: EngineKind::Render,
        acts_on: "agent",
        params: &[ParamInfo {
            name: "exposure_s",
            unit: "s",
            default: 0.0,
            low: 0.0,
            high: 0.1,
            plausible: [1e-4, 0.033],
        }],
        regimes: &[LawRegime::MovingImage],
        probes: &[&[("exposure_s", 0.01)]],
        rivals: &["defocus", "rolling_shutter"],
        separating_experiment: "hold the camera still: defocus stays, motion blur goes; its width grows with speed and lies along \
                                the movement",
    },
    effect: RenderStage::Shutter(apply),
};

fn apply(values: LawValues<'_>, shutter: &mut Shutter) {
    shutter.exposure_s = shutter.exposure_s.max(values.get_f32("exposure_s"));
}
