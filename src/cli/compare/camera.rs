//! From where a report looks at both models, unless it is told.

use solidray::Aabb;
use solidray::render::{Camera, Projection};

use super::pictures::SIZE;

/// How much of the picture the models may take, from its middle to an edge.
const FILLED: f64 = 0.94;

/// OpenSCAD's camera, nearer: the corners of the box, and not the ball around it, just fit in.
pub(super) fn near(bounds: &Aabb, projection: Projection) -> Camera {
    let camera = Camera::framing(bounds).with_projection(projection);
    let [right, up, forward] = camera.view(SIZE, bounds).axes();
    let half_height = FILLED * (0.5 * Camera::FIELD_OF_VIEW_DEG).to_radians().tan();
    let half_width = half_height * f64::from(SIZE[0]) / f64::from(SIZE[1]);
    let distances = bounds.corners().map(|corner| {
        let seen = corner - camera.center;
        let [x, y] = [seen.dot(right) / half_width, seen.dot(up) / half_height];
        // What is farther away is smaller, but for parallel rays.
        let nearer = match projection {
            Projection::Perspective => seen.dot(forward),
            Projection::Orthographic => 0.0,
        };
        x.abs().max(y.abs()) - nearer
    });
    let distance = distances.into_iter().fold(0.0, f64::max);
    if distance > 0.0 && distance.is_finite() {
        Camera { distance, ..camera }
    } else {
        camera
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn boxes_just_fit() {
        let sizes = [[1.0, 1.0, 1.0], [100.0, 3.0, 0.0], [2.0, 2.0, 90.0]];
        let projections = [Projection::Perspective, Projection::Orthographic];
        for (size, projection) in sizes.iter().flat_map(|s| projections.map(|p| (*s, p)))
        {
            let from = DVec3::new(-7.0, 20.0, 3.0);
            let bounds = Aabb::new(from, from + DVec3::from_array(size));
            let view = near(&bounds, projection).view(SIZE, &bounds);
            let [width, height] = SIZE.map(f64::from);
            let off = bounds.corners().map(|corner| {
                let [x, y] = view.place(corner).expect("before the eye");
                (x / width - 0.5).abs().max((y / height - 0.5).abs())
            });
            let most = 2.0 * off.into_iter().fold(0.0, f64::max);
            assert!((most - FILLED).abs() < 1e-9, "{size:?}: {most}");
        }
    }
}
