//! From what a camera sees to a picture of it.

use std::ops::Range;

use glam::{DVec3, Vec3};
use image::RgbImage;

use super::edges::is_edge;
use super::look::Seen;
use super::scheme::{covered, srgb8};
use super::sky::openness;
use super::{Frame, Light, Look, Scheme, Style, chunks};
use crate::color::Color;
use crate::ray::{Crossing, Sense};
use crate::scene::{Scene, Tracer};

/// Paints a frame of a scene: a pure function of its arguments.
pub fn shade(scene: &Scene, frame: &Frame, look: Look, scheme: &Scheme) -> RgbImage {
    let [width, height] = frame.size();
    let mut light = vec![Vec3::ZERO; width as usize * height as usize];
    let style = Style { look, scheme: *scheme, ..Style::default() };
    let shader = Shader { scene, style, depths: frame.depths(), color: None };
    add(&[shader], std::slice::from_ref(frame), frame.rows(), 0, &mut light);
    let mut image = RgbImage::new(width, height);
    write(&light, 1.0, &mut image);
    image
}

/// Writes pixels of light, dimmed by a factor, as sRGB.
pub(super) fn write(light: &[Vec3], factor: f32, bytes: &mut [u8]) {
    for (pixel, &light) in bytes.chunks_exact_mut(3).zip(light) {
        pixel.copy_from_slice(&srgb8(factor * light));
    }
}

/// How the frames of a scene become light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shader<'a> {
    pub(super) scene: &'a Scene,
    pub(super) style: Style,
    /// The depths that are white and dark grey in [`Look::Depth`].
    pub(super) depths: Option<[f64; 2]>,
    /// What all of it looks like, if that does not depend on its leaves, and how opaque it is.
    pub(super) color: Option<Color>,
}

/// Hatching: so many pixels from line to line, along a row; so much of that is line; so much of its
/// light is left there.
const HATCH: [f64; 2] = [9.0, 0.22];
const ON_HATCH: f32 = 0.45;

/// How much of its light is left to a pixel on an edge.
const ON_EDGES: f32 = 0.12;

/// Adds the light of the pixels in some of the rows that frames show, row by row; `sample` is which
/// of a pixel's rays they are. The first frame is of what hides, the others of what is seen through.
pub(super) fn add(
    shaders: &[Shader<'_>],
    frames: &[Frame],
    rows: Range<u32>,
    sample: u32,
    light: &mut [Vec3],
) {
    let ([shader, translucent @ ..], [frame, veils @ ..]) = (shaders, frames) else {
        return;
    };
    let width = frame.size()[0] as usize;
    let above = rows.start - frame.rows().start;
    chunks::for_each(
        light,
        width.max(1),
        || (shader.scene.tracer(), Vec::new()),
        |(tracer, layers), y, row| {
            for (x, pixel) in row.iter_mut().enumerate() {
                #[expect(clippy::cast_possible_truncation, reason = "sizes are u32")]
                let at @ [x, y] = [x as u32, y as u32 + above];
                let hit = frame.hit(x, y);
                let behind = match &hit {
                    Some(hit) => shader.surface(frame, at, hit, sample, tracer),
                    None => {
                        shader.style.look.background(&shader.style.scheme, frame.down(y))
                    }
                };
                let depth = hit.map_or(f64::INFINITY, |hit| hit.t);
                // What is as near as what hides is marked on its surface.
                layers.clear();
                for (i, veil) in veils.iter().enumerate() {
                    let hit = veil.hit(x, y).filter(|hit| hit.t <= depth);
                    layers.extend(hit.map(|hit| (hit, i)));
                }
                if layers.is_empty() {
                    *pixel += behind;
                    continue;
                }
                layers.sort_unstable_by(|(a, i), (b, j)| {
                    b.t.total_cmp(&a.t).then(i.cmp(j))
                });
                let before = layers.iter().map(|(hit, i)| {
                    let shader = &translucent[*i];
                    (shader.unshadowed(&veils[*i], at, hit), shader.opacity())
                });
                *pixel += covered(behind, before);
            }
        },
    );
}

impl Shader<'_> {
    /// How much of what is behind it it hides: 0–1.
    fn opacity(&self) -> f32 {
        self.color.map_or(1.0, |color| color.rgba[3].clamp(0.0, 1.0))
    }

    /// The light of a pixel in which a surface is seen.
    fn surface(
        &self,
        frame: &Frame,
        at: [u32; 2],
        hit: &Crossing,
        sample: u32,
        tracer: &mut Tracer<'_>,
    ) -> Vec3 {
        let mut seen = self.seen(frame, at, hit);
        if let (Light::Soft { rays }, true) = (self.style.light, self.style.look.is_lit())
        {
            seen.openness = openness(tracer, frame, at, &seen, rays, sample);
        }
        self.painted(frame, at, hit, &seen)
    }

    /// The same under [`Light::Plain`].
    fn unshadowed(&self, frame: &Frame, at: [u32; 2], hit: &Crossing) -> Vec3 {
        self.painted(frame, at, hit, &self.seen(frame, at, hit))
    }

    fn painted(&self, frame: &Frame, at: [u32; 2], hit: &Crossing, seen: &Seen) -> Vec3 {
        let Style { look, hatch, edges, .. } = self.style;
        let mut light = look.paint(seen);
        if hatch && look.is_lit() && self.is_hatched(frame, at, hit) {
            light *= ON_HATCH;
        }
        if edges && is_edge(self.scene, frame, at) {
            light *= ON_EDGES;
        }
        light
    }

    /// Whether a ray is on a line of the hatching of a section.
    fn is_hatched(&self, frame: &Frame, [x, y]: [u32; 2], hit: &Crossing) -> bool {
        let [right, down] = frame.in_view(x, y);
        let [step, width] = HATCH;
        let is_line = ((right + down) / step).rem_euclid(1.0) < width;
        is_line && self.scene.leaf(hit.leaf).kind == "half-space"
    }

    fn seen(&self, frame: &Frame, [x, y]: [u32; 2], hit: &Crossing) -> Seen {
        let ray = frame.ray(x, y);
        let [right, up, forward] = frame.view().axes();
        let in_eye_coordinates =
            |v: DVec3| DVec3::new(v.dot(right), v.dot(up), -v.dot(forward)).as_vec3();
        let normal = self.scene.normal_at(&ray, hit);
        let towards_viewer = match hit.sense {
            Sense::Enter => normal,
            Sense::Exit => -normal,
        };
        let leaf = self.scene.leaf(hit.leaf);
        let Scheme { cut, face, .. } = self.style.scheme;
        let default = if leaf.subtracted { cut } else { face };
        Seen {
            color: self.color.or(leaf.part.color).unwrap_or(default),
            leaf: hit.leaf,
            nearness: self.nearness(hit.t),
            normal,
            eye_normal: in_eye_coordinates(towards_viewer),
            to_viewer: in_eye_coordinates(-ray.dir).normalize_or(Vec3::Z),
            openness: 1.0,
        }
    }

    /// 1 at the least depth, 0 at the greatest and beyond; 1 if they are the same.
    fn nearness(&self, t: f64) -> f32 {
        let Some([near, far]) = self.depths else {
            return 1.0;
        };
        if far <= near {
            return 1.0;
        }
        #[expect(clippy::cast_possible_truncation, reason = "a fraction")]
        let nearness = ((far - t) / (far - near)).clamp(0.0, 1.0) as f32;
        nearness
    }
}
