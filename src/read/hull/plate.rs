//! Convex hulls of upright cylinders, boxes and prisms between the same two heights: what the
//! hull of their outlines is extruded to.

use glam::{DAffine3, DMat3, DVec2, DVec3, Vec3Swizzles};

use super::super::outline::{Disc, Extrusion, hull_of_discs};
use super::leaves::Leaf;
use crate::similar;
use crate::solid::Solid;

/// The hull of leaves that are upright where one of their cylinders is; `None` of others, and of all
/// that stand askew.
pub(super) fn hull(leaves: &[Leaf]) -> Option<Solid> {
    let frame = leaves.iter().find_map(|leaf| match leaf {
        Leaf::Cylinder { map, .. } => frame(map.matrix3.z_axis),
        Leaf::Ball(_) | Leaf::Points(_) => None,
    })?;
    let upright = DAffine3::from_mat3(frame.transpose());
    let mut plate = Plate { discs: Vec::new(), heights: None };
    for leaf in leaves {
        match leaf {
            Leaf::Ball(_) => return None,
            Leaf::Cylinder { radius, ends, map } => {
                plate.add_cylinder(*radius, *ends, &(upright * *map))?;
            }
            Leaf::Points(points) => {
                plate.add_prism(points.iter().map(|&p| upright.transform_point3(p)))?;
            }
        }
    }
    let [bottom, top] = plate.heights?;
    let outline = hull_of_discs(plate.discs)?;
    let solid = outline.extruded(Extrusion { bottom, top, scale: 1.0 }).ok()?;
    let is_upright = frame == DMat3::IDENTITY;
    Some(if is_upright { solid } else { solid.mapped(DAffine3::from_mat3(frame)) })
}

/// The rotation by quarter turns after which z is along an axis that is parallel to one of the
/// coordinates'.
fn frame(axis: DVec3) -> Option<DMat3> {
    let turns = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];
    let along = |[x, y, _]: &[usize; 3]| axis[*x] == 0.0 && axis[*y] == 0.0;
    let columns = turns.into_iter().find(along)?.map(|i| DVec3::AXES[i]);
    Some(DMat3::from_cols(columns[0], columns[1], columns[2]))
}

/// Upright parts of one height.
struct Plate {
    discs: Vec<Disc>,
    heights: Option<[f64; 2]>,
}

impl Plate {
    fn add_cylinder(
        &mut self,
        radius: f64,
        ends: [f64; 2],
        map: &DAffine3,
    ) -> Option<()> {
        let DMat3 { x_axis, y_axis, z_axis } = map.matrix3;
        let scale =
            similar::plane_scale(&glam::DMat2::from_cols(x_axis.xy(), y_axis.xy()))?;
        let tilt = [x_axis.z, y_axis.z, z_axis.x, z_axis.y];
        if tilt.into_iter().any(|part| part != 0.0) {
            return None;
        }
        let heights = ends.map(|z| map.transform_point3(z * DVec3::Z).z);
        self.stand_between(heights)?;
        let center = map.translation.xy();
        self.discs.push(Disc { center, radius: radius * scale });
        Some(())
    }

    /// Adds points, half of them over the other half.
    fn add_prism(&mut self, points: impl Iterator<Item = DVec3>) -> Option<()> {
        let mut points: Vec<DVec3> = points.collect();
        points.sort_by(|a, b| a.z.total_cmp(&b.z));
        let (low, high) = (points.first()?.z, points.last()?.z);
        let (below, above) = points.split_at(points.partition_point(|p| p.z <= low));
        if above.iter().any(|p| p.z < high) {
            return None;
        }
        let flat = |points: &[DVec3]| {
            let mut flat: Vec<DVec2> = points.iter().map(|p| p.xy()).collect();
            flat.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
            flat.dedup();
            flat
        };
        let flat = [flat(below), flat(above)];
        if flat[0] != flat[1] {
            return None;
        }
        self.stand_between([low, high])?;
        self.discs.extend(flat[0].iter().copied().map(Disc::point));
        Some(())
    }

    /// Whether these are the heights of all parts so far, but for what rounding does where maps
    /// add up to the same in other ways.
    fn stand_between(&mut self, [low, high]: [f64; 2]) -> Option<()> {
        let own = if low < high { [low, high] } else { [high, low] };
        let heights = self.heights.get_or_insert(own);
        let slack = 8.0 * f64::EPSILON * heights[0].abs().max(heights[1].abs());
        let is_same = |(a, b): (&f64, f64)| (a - b).abs() <= slack;
        heights.iter().zip(own).all(is_same).then_some(())
    }
}
