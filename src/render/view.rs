//! The rays of a picture.

use glam::DVec3;

use super::camera::{Camera, Projection};
use crate::aabb::Aabb;
use crate::fan::{Fan, Linear};
use crate::ray::Ray;

/// A camera with a picture in front of it: one ray for each place in the picture.
///
/// ```text
///  (0, 0)                       pixel (i, j) covers i ≤ x ≤ i + 1, j ≤ y ≤ j + 1
///     ┌───────────────┐ ──► x   its centre is (i + ½, j + ½)
///     │       up      │
///     │       ▲       │         forward is into the picture: (right, up, −forward)
///     │       C──► right        is a right-handed frame
///     │               │
///     └───────────────┘ (width, height)
///     │
///     ▼ y
/// ```
///
/// The direction of every ray has a forward component of 1, so `t` is a depth along the
/// line of sight in model units. A perspective ray starts at the eye. An orthographic one
/// starts in a plane in front of the whole bounds, or, when these are infinite, 100 times
/// the camera's distance behind the eye (where OpenSCAD stops drawing).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    size: [u32; 2],
    axes: [DVec3; 3],
    fan: Fan,
}

impl View {
    pub(super) fn new(camera: &Camera, size: [u32; 2], bounds: &Aabb) -> Self {
        let axes @ [right, up, forward] = camera.axes();
        let eye = camera.center - camera.distance * forward;
        let half_height = (0.5 * Camera::FIELD_OF_VIEW_DEG).to_radians().tan();
        let pixel = half_height / (0.5 * f64::from(size[1].max(1)));
        let (origin, dir) = match camera.projection {
            Projection::Perspective => (
                Linear::constant(eye),
                Linear { middle: forward, right: pixel * right, up: pixel * up },
            ),
            Projection::Orthographic => {
                let start = start_depth(camera, eye, forward, bounds);
                let step = camera.distance * pixel;
                let middle = eye + start * forward;
                (
                    Linear { middle, right: step * right, up: step * up },
                    Linear::constant(forward),
                )
            }
        };
        Self { size, axes, fan: Fan { origin, dir } }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The directions right, up and forward in the picture, as unit vectors.
    pub fn axes(&self) -> [DVec3; 3] {
        self.axes
    }

    /// The ray through a place in the picture: `x` pixels from its left edge and `y` from
    /// its upper one. Places beyond the edges have rays too.
    ///
    /// A camera without finite numbers makes rays that are not
    /// [valid](Ray::is_valid), which meet nothing.
    pub fn ray(&self, x: f64, y: f64) -> Ray {
        let [right, up] = self.in_fan(x, y);
        self.fan.ray(right, up)
    }

    /// Where in the picture a point appears, in the pixels of [`View::ray`]; perhaps beyond its
    /// edges. None for a point that no ray leads to: at or behind the eye of a perspective view.
    pub fn place(&self, point: DVec3) -> Option<[f64; 2]> {
        let [right, up, forward] = self.axes;
        let Fan { origin, dir } = self.fan;
        let seen = point - origin.middle;
        let depth = seen.dot(forward);
        let pixel = (origin.right + depth * dir.right).dot(right);
        let [width, height] = self.size.map(f64::from);
        let place =
            [0.5 * width + seen.dot(right) / pixel, 0.5 * height - seen.dot(up) / pixel];
        (pixel > 0.0 && place.iter().all(|x| x.is_finite())).then_some(place)
    }

    /// How wide a pixel is at a depth.
    #[cfg(feature = "image")]
    pub(super) fn footprint(&self, t: f64) -> f64 {
        (self.fan.origin.right + t * self.fan.dir.right).length()
    }

    /// All rays of the picture.
    pub(super) fn fan(&self) -> &Fan {
        &self.fan
    }

    /// Where in the fan a place in the picture is.
    pub(super) fn in_fan(&self, x: f64, y: f64) -> [f64; 2] {
        let [width, height] = self.size.map(f64::from);
        [x - 0.5 * width, 0.5 * height - y]
    }
}

/// The depth, seen from the eye, at which orthographic rays start.
fn start_depth(camera: &Camera, eye: DVec3, forward: DVec3, bounds: &Aabb) -> f64 {
    if bounds.is_empty() {
        return 0.0;
    }
    let depths = bounds.corners().map(|corner| (corner - eye).dot(forward));
    let nearest = depths.into_iter().fold(f64::INFINITY, f64::min);
    // A whole diagonal before the nearest corner, so that rounding does not matter.
    let start = nearest - bounds.size().length();
    if start.is_finite() { start } else { -100.0 * camera.distance }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a point appears in the picture.
    fn project(camera: &Camera, size: [u32; 2], p: DVec3) -> [f64; 2] {
        let [right, up, forward] = camera.axes();
        let seen = p - camera.center;
        let depth = match camera.projection {
            Projection::Perspective => seen.dot(forward) + camera.distance,
            Projection::Orthographic => camera.distance,
        };
        let [width, height] = size.map(f64::from);
        let scale = 0.5 * height / (11.25_f64.to_radians().tan() * depth);
        [0.5 * width + scale * seen.dot(right), 0.5 * height - scale * seen.dot(up)]
    }

    /// First and last column, first and last row (both exclusive) of the box from the
    /// origin to (10, 10, 10).
    fn silhouette(camera: &Camera, size: [u32; 2]) -> [f64; 4] {
        let cube = Aabb::new(DVec3::ZERO, DVec3::splat(10.0));
        let places = cube.corners().map(|corner| project(camera, size, corner));
        places.iter().fold([1e9, -1e9, 1e9, -1e9], |[x0, x1, y0, y1], &[x, y]| {
            [x0.min(x), x1.max(x), y0.min(y), y1.max(y)]
        })
    }

    fn gimbal(numbers: [f64; 7]) -> Camera {
        Camera::gimbal(numbers).expect("finite numbers")
    }

    fn vector(numbers: [f64; 6]) -> Camera {
        Camera::vector(numbers).expect("finite numbers")
    }

    /// The extent in pixels of `cube(10)` in pictures by OpenSCAD 2021.01.
    #[test]
    fn silhouettes_are_those_of_openscad() {
        use Projection::Orthographic;
        let cube = Aabb::new(DVec3::ZERO, DVec3::splat(10.0));
        let turned = gimbal([1.0, 2.0, 3.0, 70.0, 30.0, -40.0, 60.0]);
        let upright = vector([30.0, -40.0, 35.0, 2.0, 3.0, 4.0]);
        let framed = Camera::framing(&cube);
        let (wide, tall) = ([400, 300], [200, 500]);
        for (what, camera, size, seen) in [
            (
                "--camera=1,2,3,55,0,25,60",
                gimbal([1.0, 2.0, 3.0, 55.0, 0.0, 25.0, 60.0]),
                wide,
                [176.0, 348.0, 27.0, 225.0],
            ),
            ("--camera=1,2,3,70,30,-40,60", turned, wide, [99.0, 302.0, 13.0, 188.0]),
            (
                "the same with --projection=o",
                turned.with_projection(Orthographic),
                wide,
                [92.0, 308.0, 12.0, 192.0],
            ),
            ("--viewall", turned.view_all(&cube), wide, [115.0, 286.0, 36.0, 182.0]),
            (
                "--viewall --autocenter",
                turned.autocenter(&cube).view_all(&cube),
                wide,
                [55.0, 347.0, 19.0, 280.0],
            ),
            (
                "--viewall --autocenter --projection=o",
                turned.autocenter(&cube).view_all(&cube).with_projection(Orthographic),
                wide,
                [54.0, 346.0, 28.0, 272.0],
            ),
            ("--camera=30,-40,35,2,3,4", upright, wide, [155.0, 336.0, 45.0, 244.0]),
            (
                "the same with --projection=o",
                upright.with_projection(Orthographic),
                wide,
                [158.0, 332.0, 40.0, 238.0],
            ),
            (
                "with --viewall",
                upright.view_all(&cube),
                wide,
                [158.0, 328.0, 51.0, 238.0],
            ),
            (
                "with --viewall --autocenter",
                upright.autocenter(&cube).view_all(&cube),
                wide,
                [71.0, 321.0, 26.0, 294.0],
            ),
            (
                "--camera=2,3,70,2,3,4",
                vector([2.0, 3.0, 70.0, 2.0, 3.0, 4.0]),
                wide,
                [175.0, 301.0, 62.0, 188.0],
            ),
            (
                "--camera=2,3,-70,2,3,4",
                vector([2.0, 3.0, -70.0, 2.0, 3.0, 4.0]),
                wide,
                [114.0, 222.0, 75.0, 182.0],
            ),
            (
                "--camera=-20,15,-60,2,3,4",
                vector([-20.0, 15.0, -60.0, 2.0, 3.0, 4.0]),
                wide,
                [87.0, 242.0, 78.0, 253.0],
            ),
            ("no camera", framed, wide, [73.0, 315.0, 23.0, 293.0]),
            (
                "no camera, --projection=o",
                framed.with_projection(Orthographic),
                wide,
                [87.0, 313.0, 16.0, 284.0],
            ),
            ("no camera, tall", framed, tall, [-111.0, 292.0, 38.0, 488.0]),
            ("no camera, no size", framed, [512, 512], [40.0, 453.0, 39.0, 499.0]),
        ] {
            let predicted = silhouette(&camera, size);
            for (a, b) in predicted.into_iter().zip(seen) {
                // A pixel is drawn when its centre is covered: half a pixel each way,
                // and as much again for how corners are rasterised.
                assert!((a - b).abs() < 1.0, "{what}: {predicted:?}, not {seen:?}");
            }
        }
    }

    #[test]
    fn rays_go_where_points_appear() {
        let p = DVec3::new(3.0, -2.0, 7.0);
        let bounds = Aabb::new(DVec3::splat(-20.0), DVec3::splat(20.0));
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let camera = gimbal([1.0, 2.0, 3.0, 70.0, 30.0, -40.0, 60.0])
                .with_projection(projection);
            let [x, y] = project(&camera, [400, 300], p);
            let view = camera.view([400, 300], &bounds);
            let ray = view.ray(x, y);
            let forward = camera.axes()[2];
            assert!((ray.dir.dot(forward) - 1.0).abs() < 1e-15);
            let t = (p - ray.origin).dot(forward);
            assert!(ray.at(t).distance(p) < 1e-12);
            let place = view.place(p).expect("it is in front of the eye");
            assert!(
                (place[0] - x).hypot(place[1] - y) < 1e-10,
                "{place:?}, not {x}, {y}"
            );
        }
    }

    #[test]
    fn points_behind_the_eye_have_no_place() {
        let camera = gimbal([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 50.0]);
        let view = camera.view([400, 300], &Aabb::ALL);
        assert_eq!(view.place(DVec3::ZERO), Some([200.0, 150.0]));
        assert_eq!(view.place(DVec3::new(0.0, 0.0, 50.0)), None);
        assert_eq!(view.place(DVec3::new(1.0, 2.0, 60.0)), None);
        assert_eq!(view.place(DVec3::NAN), None);
        let blind = gimbal([0.0; 7]).with_projection(Projection::Orthographic);
        assert_eq!(blind.view([400, 300], &Aabb::ALL).place(DVec3::ONE), None);
        let parallel = camera.with_projection(Projection::Orthographic);
        let place =
            parallel.view([400, 300], &Aabb::ALL).place(DVec3::new(0.0, 0.0, 60.0));
        assert_eq!(place, Some([200.0, 150.0]));
    }

    #[test]
    fn orthographic_rays_start_before_everything() {
        let camera = gimbal([0.0, 0.0, 0.0, 55.0, 0.0, 25.0, 1.0])
            .with_projection(Projection::Orthographic);
        let far_out = Aabb::new(DVec3::splat(-900.0), DVec3::splat(900.0));
        for bounds in [far_out, Aabb::EMPTY, Aabb::ALL] {
            let ray = camera.view([8, 8], &bounds).ray(4.0, 4.0);
            assert!(ray.is_valid());
            for corner in bounds.corners().into_iter().filter(|c| c.is_finite()) {
                assert!((corner - ray.origin).dot(ray.dir) > 0.0);
            }
        }
    }

    #[test]
    fn no_camera_makes_rays_that_are_not_numbers() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let camera = gimbal([0.0; 7]).with_projection(projection);
            for size in [[0, 0], [1, 1], [7, 3]] {
                assert!(camera.view(size, &Aabb::EMPTY).ray(0.5, 0.5).is_valid());
            }
        }
    }
}
