//! The rule of stopping where views from three sides agree, which is no measure of the error.

use glam::DVec3;
use solidray::{Ray, Scene};

/// The volume as three views along the axes have it, on grids of twice as many rays each way
/// until they agree within a part of the box around the solid, and how many rays that took;
/// nothing if they do not agree on any grid. `gqa` of BRL-CAD stops so, at 1/1000 of the box.
pub(crate) fn where_views_agree(scene: &Scene, part: f64) -> Option<(f64, u64)> {
    const FIRST: u32 = 8;
    const LAST: u32 = 128;
    let whole = scene.bounds().size().element_product();
    let (mut rays, mut cells) = (0, FIRST);
    while cells <= LAST {
        let views = [0, 1, 2].map(|axis| view(scene, axis, cells));
        rays += 3 * u64::from(cells) * u64::from(cells);
        let least = views.into_iter().fold(f64::INFINITY, f64::min);
        let most = views.into_iter().fold(0.0, f64::max);
        if most - least <= part * whole {
            return Some((views.iter().sum::<f64>() / 3.0, rays));
        }
        cells *= 2;
    }
    None
}

/// The volume as parallel rays through the middles of square cells have it.
fn view(scene: &Scene, axis: usize, cells: u32) -> f64 {
    let (bounds, mut tracer) = (scene.bounds(), scene.tracer());
    let [u, v] = [(axis + 1) % 3, (axis + 2) % 3].map(|k| DVec3::AXES[k] * bounds.size());
    let step = 1.0 / f64::from(cells);
    let mut length = 0.0;
    for i in 0..cells {
        for j in 0..cells {
            let [x, y] = [i, j].map(|k| (f64::from(k) + 0.5) * step);
            let ray = Ray::new(bounds.min + x * u + y * v, DVec3::AXES[axis]);
            length += tracer.spans(&ray).iter().map(|span| span.length()).sum::<f64>();
        }
    }
    length * u.length() * v.length() * step * step
}
