//! Agreement of the back ends: every image of a view, pixel by pixel.
//!
//! Images agree at a pixel where the 3 by 3 pixels around it show one id and no jump of depth of over 2 % (DESIGN 4.2). At
//! every other pixel a picture may show what the other back end shows within one pixel: values must lie among those of the 3 by 3
//! pixels, and what lies elsewhere is counted.

use dwell_render::{Camera, Frame, VisibilityPath};
use std::collections::BTreeMap;

/// Tolerance of depths, m.
const DEPTH_M: f32 = 1e-3;
/// Surfaces as near to one another as this coincide: either may be seen, m.
const COINCIDENT_M: f32 = 1e-4;
/// Jump of depth between pixels that are not compared alone, as a share of the nearest.
const JUMP: f32 = 0.02;
/// Tolerance of normals, degrees.
const TURN_DEG: f32 = 0.1;
/// Tolerance of flow: pixels, and as a share of it.
const FLOW: [f32; 2] = [0.02, 1e-3];
/// Tolerance of reflectances.
const ALBEDO: f32 = 0.01;
/// Levels of 255 by which colours may differ.
const LEVELS: f32 = 2.0;

/// The share of pixels that may show the other of two coincident things, by rays and by raster: the first take the lower id as
/// `cpu` does, the second either. The SUNCG house has 1.7 %.
const COINCIDENT: [f64; 2] = [1e-3, 2.5e-2];
/// The share of pixels that may show what is nowhere around, by rays and by raster: coincident surfaces of one thing, which differ
/// in what they show and not in depth or id.
const BEYOND: [f64; 2] = [1e-3, 6e-3];

/// The share of inner pixels whose normal may be none of those around, by rays and by raster: a triangle narrower than a pixel of a
/// rounded surface, which the other does not hit.
const TURNED: [f64; 2] = [0.0, 1e-4];
/// The greatest angle of such a normal, degrees.
const MOST_TURN_DEG: f32 = 1.0;

/// Images whose values are counted where they lie beyond what is around.
const IMAGES: [&str; 6] = ["depth", "instance", "normals", "flow", "albedo", "rgb"];

/// Counts of compared pixels.
#[derive(Debug, Default)]
pub(crate) struct Count {
    pub(crate) pixels: usize,
    /// Pixels whose neighbourhood holds one id and no jump of depth.
    pub(crate) inner: usize,
    /// Pixels that show another of two coincident things.
    pub(crate) coincident: usize,
    /// Inner pixels whose colour or reflectance differs.
    colors: usize,
    /// Inner pixels whose normal is none of those around.
    turned: usize,
    /// Sum of the differences of colour at inner pixels, levels.
    levels: f64,
    /// Other pixels whose value lies beyond those around, by image.
    beyond: [usize; IMAGES.len()],
    /// The same by the id that the pixel shows, with the first such pixel.
    by_id: BTreeMap<i32, ([usize; IMAGES.len()], String)>,
}

/// One view by both.
struct Compared<'a> {
    cpu: &'a Frame,
    gpu: &'a Frame,
    pixel: usize,
    /// The 3 by 3 pixels around it that there are.
    around: Vec<usize>,
}

/// The angle between two directions, degrees; none between nothing and nothing.
fn turn_deg(a: &[f32], b: &[f32]) -> f32 {
    let (a, b) = (glam::Vec3::from_slice(a), glam::Vec3::from_slice(b));
    if a == b {
        return 0.0;
    }
    a.cross(b).length().atan2(a.dot(b)).to_degrees()
}

impl Compared<'_> {
    /// The values of an image at a pixel.
    fn of<'a>(&self, image: &'a [f32], pixel: usize) -> &'a [f32] {
        let parts = image.len() / self.cpu.depth.len();
        &image[pixel * parts..(pixel + 1) * parts]
    }

    /// Returns whether all values of the gpu's image lie among the cpu's around, give or take `slack` and `share` of them.
    fn is_among(&self, cpu: &[f32], gpu: &[f32], slack: f32, share: f32) -> bool {
        let found = self.of(gpu, self.pixel).iter().enumerate();
        found.into_iter().all(|(part, found)| {
            let around = self.around.iter().map(|k| self.of(cpu, *k)[part]);
            let (least, most) = range(around);
            let slack = slack + share * least.abs().max(most.abs());
            (least - slack..=most + slack).contains(found)
        })
    }

    /// The greatest difference at the pixel itself.
    fn off(&self, cpu: &[f32], gpu: &[f32]) -> f32 {
        let pairs = self
            .of(cpu, self.pixel)
            .iter()
            .zip(self.of(gpu, self.pixel));
        pairs.fold(0.0, |most, (a, b)| most.max((a - b).abs()))
    }

    /// The least angle between the gpu's normal and the cpu's around, degrees.
    fn turn_deg(&self) -> f32 {
        let normal = self.of(&self.gpu.normals, self.pixel);
        let around = self.around.iter();
        around
            .map(|k| turn_deg(self.of(&self.cpu.normals, *k), normal))
            .fold(f32::INFINITY, f32::min)
    }

    fn has_id_around(&self) -> bool {
        let found = self.gpu.instance[self.pixel];
        self.around.iter().any(|k| self.cpu.instance[*k] == found)
    }
}

fn range(values: impl Iterator<Item = f32>) -> (f32, f32) {
    values.fold(
        (f32::INFINITY, f32::NEG_INFINITY),
        |(least, most), value| (least.min(value), most.max(value)),
    )
}

impl Count {
    /// Compares a view, or panics and names the pixel.
    pub(crate) fn compare(&mut self, name: &str, camera: &Camera, (cpu, gpu): &(Frame, Frame)) {
        let (width, height) = (camera.width() as usize, camera.height() as usize);
        let colors = |frame: &Frame| frame.rgb.iter().map(|b| f32::from(*b)).collect::<Vec<_>>();
        let colors = (colors(cpu), colors(gpu));
        for pixel in 0..width * height {
            let (x, y) = (pixel % width, pixel / width);
            let around = (y.saturating_sub(1)..(y + 2).min(height))
                .flat_map(|y| (x.saturating_sub(1)..(x + 2).min(width)).map(move |x| (x, y)))
                .map(|(x, y)| y * width + x);
            let one = Compared {
                cpu,
                gpu,
                pixel,
                around: around.collect(),
            };
            self.pixels += 1;
            self.pixel(&one, &colors, &format_args!("{name}: pixel ({x}, {y})"));
        }
    }

    fn pixel(
        &mut self,
        one: &Compared<'_>,
        colors: &(Vec<f32>, Vec<f32>),
        place: &std::fmt::Arguments<'_>,
    ) {
        let &Compared {
            cpu, gpu, pixel, ..
        } = one;
        let (near, far) = range(one.around.iter().map(|k| cpu.depth[*k]));
        let id = cpu.instance[pixel];
        let is_one_thing = one.around.iter().all(|k| cpu.instance[*k] == id);
        let off_m = one.off(&cpu.depth, &gpu.depth);
        let other = gpu.instance[pixel];
        if other == id {
            assert_eq!(cpu.semantic[pixel], gpu.semantic[pixel], "{place}");
        } else if off_m < COINCIDENT_M {
            // The rest tells of the other surface.
            self.coincident += 1;
            return;
        }
        let turn_deg = one.turn_deg();
        let [flow_px, flow_share] = FLOW;
        let has_flow = one.is_among(&cpu.flow, &gpu.flow, flow_px, flow_share);
        if is_one_thing && far - near <= JUMP * near {
            self.inner += 1;
            assert_eq!(id, other, "{place}: depth off by {off_m} m");
            assert!(
                off_m < DEPTH_M,
                "{place}: depth {} off by {off_m} m",
                cpu.depth[pixel]
            );
            // A pixel on an edge between triangles may show the one or the other.
            assert!(
                turn_deg < MOST_TURN_DEG,
                "{place}: normal off by {turn_deg} degrees"
            );
            self.turned += usize::from(turn_deg >= TURN_DEG);
            assert!(has_flow, "{place}: flow {:?}", one.of(&gpu.flow, pixel));
            let off_color = one.off(&colors.0, &colors.1);
            let off = one.off(&cpu.albedo, &gpu.albedo);
            self.colors += usize::from(off_color > LEVELS || off > ALBEDO);
            self.levels += f64::from(off_color);
            return;
        }
        let is_there = [
            one.is_among(&cpu.depth, &gpu.depth, DEPTH_M, 0.0),
            one.has_id_around(),
            turn_deg < TURN_DEG,
            has_flow,
            one.is_among(&cpu.albedo, &gpu.albedo, ALBEDO, 0.0),
            one.is_among(&colors.0, &colors.1, LEVELS, 0.0),
        ];
        if is_there.contains(&false) {
            let first = || {
                let images = [&cpu.albedo, &gpu.albedo, &cpu.normals, &gpu.normals];
                let values = images.map(|image| one.of(image, pixel));
                format!("{place}: albedo and normals of cpu, gpu: {values:?}")
            };
            let (counts, _) = self
                .by_id
                .entry(other)
                .or_insert_with(|| (Default::default(), first()));
            for (k, is_there) in is_there.into_iter().enumerate() {
                self.beyond[k] += usize::from(!is_there);
                counts[k] += usize::from(!is_there);
            }
        }
    }

    /// Prints the figures and checks those that are shares. `least`: the share of inner pixels.
    pub(crate) fn finish(&self, name: &str, path: VisibilityPath, least: f64) {
        let name = &format!("{name}, {}", path.name());
        let (pixels, inner) = (self.pixels as f64, self.inner.max(1) as f64);
        println!(
            "{name}: {} pixels, {} inner, {} coincident, {} colours off by more than {LEVELS}, mean {:.4} levels; beyond what \
             is around: {:?} of {IMAGES:?}",
            self.pixels,
            self.inner,
            self.coincident,
            self.colors,
            self.levels / inner,
            self.beyond,
        );
        assert!(inner > least * pixels, "{name}: {self:?}");
        // Pixels on edges between triangles of one thing, of other materials or levels of a texture.
        assert!((self.colors as f64) < 2e-3 * inner, "{name}: {self:?}");
        assert!(self.levels < 0.05 * inner, "{name}: {self:?}");
        let by = usize::from(path == VisibilityPath::Raster);
        let most = TURNED[by];
        assert!(self.turned as f64 <= most * inner, "{name}: {self:?}");
        let most = COINCIDENT[by];
        assert!(self.coincident as f64 <= most * pixels, "{name}: {self:?}");
        for (beyond, image) in self.beyond.iter().zip(IMAGES) {
            let is_place = ["depth", "instance"].contains(&image);
            let most = BEYOND[if is_place { 0 } else { by }];
            assert!(
                (*beyond as f64) <= most * pixels,
                "{name}, {image}: {self:?}"
            );
        }
    }
}
