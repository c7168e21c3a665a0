//! Where the eye is: cameras as OpenSCAD describes them.
//!
//! What is said here of OpenSCAD was measured on pictures by version 2021.01, in which
//! the silhouettes of boxes agree with these formulas to the pixel.

use glam::{DMat3, DVec3};
use thiserror::Error;

use super::view::View;
use crate::aabb::Aabb;
use crate::angle::{cos_deg, sin_deg};

/// A camera that looks at a centre from a distance, described as in OpenSCAD.
///
/// ```text
///  rotation (0, 0, 0): from above     rotation (90, 0, 0): from the front
///
///        +y  up                              +z  up
///         │                                   │
///         │                                   │
///         C────── +x  right                   C────── +x  right
///   the eye is at C + (0, 0, d)         the eye is at C − (0, d, 0)
/// ```
///
/// The eye starts straight above the centre C. The camera is then turned about C as a
/// body would be: by `rotation_deg.x` about the x-axis, `rotation_deg.y` about the
/// y-axis, `rotation_deg.z` about the z-axis, in this order, about axes that stay put.
///
/// The vertical field of view is [`Camera::FIELD_OF_VIEW_DEG`]; pixels are square, so a
/// wider picture shows more at its sides and no less at its top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The point in the middle of the picture.
    pub center: DVec3,
    /// The turns about the x-, y- and z-axis, in degrees.
    pub rotation_deg: DVec3,
    /// From the eye to the centre, in model units; not negative. It sets the scale of an
    /// orthographic picture too. At zero a perspective camera looks out of its centre
    /// and an orthographic one sees a single line.
    pub distance: f64,
    /// How depth is drawn.
    pub projection: Projection,
}

/// How depth is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Projection {
    /// Far things are smaller. Only what is in front of the eye is seen.
    #[default]
    Perspective,
    /// All rays are parallel; things at the centre are as large as in perspective. What
    /// is behind the eye is seen too.
    Orthographic,
}

/// Numbers that make no camera.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CameraError {
    /// Neither 6 nor 7 of them.
    #[error(
        "a camera takes 7 numbers (centre, rotation, distance) or 6 (eye, centre), not {0}"
    )]
    Count(usize),
    /// An infinite number, or none.
    #[error("a camera takes finite numbers, not {0}")]
    NotFinite(f64),
    /// A negative distance, or one beyond the largest number.
    #[error("a camera's distance is finite and not negative, not {0}")]
    Distance(f64),
    /// An eye at the centre, which looks nowhere.
    #[error("a camera's eye and centre are two points, not both at {0}")]
    Direction(DVec3),
}

impl Default for Camera {
    /// OpenSCAD's: around the origin from (55°, 0°, 25°), 140 units away.
    fn default() -> Self {
        Self {
            center: DVec3::ZERO,
            rotation_deg: DVec3::new(55.0, 0.0, 25.0),
            distance: 140.0,
            projection: Projection::Perspective,
        }
    }
}

impl Camera {
    /// The angle between the rays through the middle of the upper and the lower edge.
    pub const FIELD_OF_VIEW_DEG: f64 = 22.5;

    /// The camera of OpenSCAD's option `--camera`: [`Camera::gimbal`] from 7 numbers,
    /// [`Camera::vector`] from 6.
    ///
    /// # Errors
    ///
    /// Another count of numbers, or an error of those two.
    pub fn from_numbers(numbers: &[f64]) -> Result<Self, CameraError> {
        match *numbers {
            [a, b, c, d, e, f] => Self::vector([a, b, c, d, e, f]),
            [a, b, c, d, e, f, g] => Self::gimbal([a, b, c, d, e, f, g]),
            _ => Err(CameraError::Count(numbers.len())),
        }
    }

    /// The camera with this centre (3 numbers), rotation in degrees (3) and distance.
    ///
    /// A distance of zero is of use where [`Camera::view_all`] replaces it.
    ///
    /// # Errors
    ///
    /// A number that is not finite, or a negative distance.
    pub fn gimbal(numbers: [f64; 7]) -> Result<Self, CameraError> {
        all_finite(&numbers)?;
        let [x, y, z, rx, ry, rz, distance] = numbers;
        if distance < 0.0 {
            return Err(CameraError::Distance(distance));
        }
        let center = DVec3::new(x, y, z);
        let rotation_deg = DVec3::new(rx, ry, rz);
        Ok(Self { center, rotation_deg, distance, ..Self::default() })
    }

    /// The camera with this eye (3 numbers) and centre (3), upright: +z points up in the
    /// picture, or +y where the view is straight down or straight up.
    ///
    /// # Errors
    ///
    /// A number that is not finite, an eye at the centre, or one too far from it.
    pub fn vector(numbers: [f64; 6]) -> Result<Self, CameraError> {
        all_finite(&numbers)?;
        let [ex, ey, ez, cx, cy, cz] = numbers;
        let center = DVec3::new(cx, cy, cz);
        let to_eye = DVec3::new(ex, ey, ez) - center;
        let (distance, level) = (to_eye.length(), to_eye.x.hypot(to_eye.y));
        if distance == 0.0 {
            return Err(CameraError::Direction(center));
        }
        if !distance.is_finite() {
            return Err(CameraError::Distance(distance));
        }
        let turn_deg = if level > 0.0 {
            to_eye.y.atan2(to_eye.x).to_degrees() + 90.0
        } else if to_eye.z > 0.0 {
            0.0
        } else {
            180.0
        };
        let tilt_deg = level.atan2(to_eye.z).to_degrees();
        let rotation_deg = DVec3::new(tilt_deg, 0.0, turn_deg);
        Ok(Self { center, rotation_deg, distance, ..Self::default() })
    }

    /// The default camera moved so that it shows all of a box: what OpenSCAD does
    /// without `--camera`.
    pub fn framing(bounds: &Aabb) -> Self {
        Self::default().autocenter(bounds).view_all(bounds)
    }

    /// With another projection.
    #[must_use]
    pub fn with_projection(self, projection: Projection) -> Self {
        Self { projection, ..self }
    }

    /// With its centre in the middle of a box, which leaves direction and distance as
    /// they are. A box that is empty or unbounded changes nothing.
    ///
    /// OpenSCAD ignores `--autocenter` where `--viewall` is not given as well.
    #[must_use]
    pub fn autocenter(self, bounds: &Aabb) -> Self {
        if !bounds.is_bounded() {
            return self;
        }
        Self { center: bounds.center(), ..self }
    }

    /// At the distance from which the ball around the camera's centre that contains a
    /// box's circumscribed ball just touches the upper and lower edges of the picture.
    /// To be called after [`Camera::autocenter`], if at all: the farther the centre is
    /// from the middle of the box, the farther away the eye.
    ///
    /// The picture's width plays no part, as in OpenSCAD: one taller than wide can cut
    /// off the sides. A box that is empty or unbounded changes nothing.
    #[must_use]
    pub fn view_all(self, bounds: &Aabb) -> Self {
        if !bounds.is_bounded() {
            return self;
        }
        let off_center = bounds.center().distance(self.center);
        let radius = off_center + 0.5 * bounds.size().length();
        let distance = radius / (0.5 * Self::FIELD_OF_VIEW_DEG).to_radians().sin();
        if distance > 0.0 && distance.is_finite() {
            Self { distance, ..self }
        } else {
            self
        }
    }

    /// The rays of a picture of `size` = \[width, height\] pixels of something within
    /// `bounds`; [`Aabb::ALL`] if they are not known.
    pub fn view(&self, size: [u32; 2], bounds: &Aabb) -> View {
        View::new(self, size, bounds)
    }

    /// The directions right, up and forward in the picture, as unit vectors.
    pub(super) fn axes(&self) -> [DVec3; 3] {
        let [x, y, z] = self.rotation_deg.to_array().map(|a| (sin_deg(a), cos_deg(a)));
        let (about_x, about_y, about_z) = (
            DMat3::from_cols(
                DVec3::X,
                DVec3::new(0.0, x.1, x.0),
                DVec3::new(0.0, -x.0, x.1),
            ),
            DMat3::from_cols(
                DVec3::new(y.1, 0.0, -y.0),
                DVec3::Y,
                DVec3::new(y.0, 0.0, y.1),
            ),
            DMat3::from_cols(
                DVec3::new(z.1, z.0, 0.0),
                DVec3::new(-z.0, z.1, 0.0),
                DVec3::Z,
            ),
        );
        let turn = about_z * about_y * about_x;
        [turn.x_axis, turn.y_axis, -turn.z_axis]
    }
}

fn all_finite(numbers: &[f64]) -> Result<(), CameraError> {
    match numbers.iter().find(|number| !number.is_finite()) {
        Some(&number) => Err(CameraError::NotFinite(number)),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_from_above_and_from_the_front() {
        let camera = |rotation| Camera { rotation_deg: rotation, ..Camera::default() };
        let from_above = camera(DVec3::ZERO).axes();
        assert_eq!(from_above, [DVec3::X, DVec3::Y, DVec3::NEG_Z]);
        let from_the_front = camera(DVec3::new(90.0, 0.0, 0.0)).axes();
        assert_eq!(from_the_front, [DVec3::X, DVec3::Z, DVec3::Y]);
        let from_the_right = camera(DVec3::new(90.0, 0.0, 90.0)).axes();
        assert_eq!(from_the_right, [DVec3::Y, DVec3::Z, DVec3::NEG_X]);
    }

    #[test]
    fn a_vector_camera_looks_from_its_eye() {
        for numbers in [
            [30.0, -40.0, 35.0, 2.0, 3.0, 4.0],
            [-20.0, 15.0, -60.0, 2.0, 3.0, 4.0],
            [2.0, 3.0, 70.0, 2.0, 3.0, 4.0],
            [2.0, 3.0, -70.0, 2.0, 3.0, 4.0],
        ] {
            let camera = Camera::vector(numbers).expect("two finite points");
            let [right, up, forward] = camera.axes();
            let eye = camera.center - camera.distance * forward;
            let expected = DVec3::new(numbers[0], numbers[1], numbers[2]);
            assert!(eye.distance(expected) < 1e-13, "{eye} is not {expected}");
            assert!(right.z.abs() < 1e-15, "level");
            assert!(up.z > 0.0 || up == DVec3::Y, "upright, not {up}");
        }
    }

    #[test]
    fn numbers_that_make_no_camera() {
        let message = |numbers: &[f64]| {
            Camera::from_numbers(numbers).map_err(|e| e.to_string()).expect_err("refused")
        };
        assert_eq!(
            message(&[1.0, 2.0]),
            "a camera takes 7 numbers (centre, rotation, distance) or 6 (eye, centre), not 2"
        );
        assert_eq!(
            message(&[1.0, f64::NAN, 3.0, 0.0, 0.0, 0.0]),
            "a camera takes finite numbers, not NaN"
        );
        assert_eq!(
            message(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -2.5]),
            "a camera's distance is finite and not negative, not -2.5"
        );
        assert_eq!(
            message(&[1e200, 0.0, 0.0, 0.0, 0.0, 0.0]),
            "a camera's distance is finite and not negative, not inf"
        );
        assert_eq!(
            message(&[1.0, 2.0, 3.0, 1.0, 2.0, 3.0]),
            "a camera's eye and centre are two points, not both at [1, 2, 3]"
        );
    }

    #[test]
    fn a_box_without_size_changes_nothing() {
        for bounds in [Aabb::EMPTY, Aabb::ALL, Aabb::new(DVec3::ZERO, DVec3::ZERO)] {
            assert_eq!(Camera::framing(&bounds), Camera::default());
        }
        let vast = Aabb::new(DVec3::splat(-1e300), DVec3::splat(1e300));
        assert!(Camera::framing(&vast).distance.is_finite());
    }
}
