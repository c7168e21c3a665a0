//! Regular prisms, pyramids and frusta of these.

use glam::{DVec2, DVec3};

use super::parameter::{finite, not_negative, size};
use super::{BadParameter, Describe, Extent, Facets, Flat, MOST_FACES};
use crate::angle::{cos_deg, sin_deg};
use crate::mesh::round;
use crate::rounded::Rounded;

/// What is between two regular polygons about the z-axis, each with a corner on +x; one may be a
/// point. Its faces are the bottom and the top, but for one that is a point, and then the sides
/// from +x counter-clockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prism {
    /// How many sides the polygons have: 3 to 30.
    pub sides: u32,
    /// How far the corners of the polygons are from the axis, at the bottom and at the top.
    pub radii: [f64; 2],
    /// The heights of the bottom and of the top.
    pub ends: [f64; 2],
}

impl Prism {
    /// The angle between the corners on both sides of a side, in degrees.
    fn step(&self) -> f64 {
        360.0 / f64::from(self.sides)
    }

    /// The side between two corners. Both polygons touch a circle about the axis with their
    /// sides; the plane through two of these is as steep as the way from one circle to the other.
    fn side(&self, i: u32) -> Flat {
        let angle = self.step() * (f64::from(i) + 0.5);
        let outward = DVec2::new(cos_deg(angle), sin_deg(angle));
        let [below, above] = self.radii.map(|radius| radius * cos_deg(0.5 * self.step()));
        let [bottom, top] = self.ends;
        let steepness = (below - above) / (top - bottom);
        // From the larger end, so that nothing cancels.
        let (apothem, z) = if below >= above { (below, bottom) } else { (above, top) };
        Flat {
            normal: outward.extend(steepness),
            offset: apothem + steepness * z,
            point: (apothem * outward).extend(z),
        }
    }
}

impl Describe for Prism {
    fn name(&self) -> &'static str {
        if self.radii.contains(&0.0) { "pyramid" } else { "prism" }
    }

    fn check(&self) -> Result<(), BadParameter> {
        let [[a, b], [bottom, top]] = [self.radii, self.ends];
        if self.sides < 3 || self.sides as usize > MOST_FACES - 2 {
            let value = f64::from(self.sides);
            return Err(BadParameter { parameter: "number of sides", value });
        }
        not_negative("bottom radius", a)?;
        not_negative("top radius", b)?;
        size("larger radius", a.max(b))?;
        finite("bottom", bottom)?;
        finite("top", top)?;
        size("height", top - bottom)
    }

    fn planes(&self) -> Vec<Flat> {
        let caps = [-DVec3::Z, DVec3::Z].into_iter().zip(self.ends).zip(self.radii);
        let caps = caps.filter(|&(_, radius)| radius > 0.0).map(|((normal, z), _)| {
            Flat { normal, offset: z * normal.z, point: z * DVec3::Z }
        });
        caps.chain((0..self.sides).map(|i| self.side(i))).collect()
    }

    fn extent(&self) -> Extent {
        let ends = self.radii.into_iter().zip(self.ends);
        let corners = ends.flat_map(|(radius, z)| {
            round::circle(self.sides, radius).into_iter().map(move |p| p.extend(z))
        });
        Extent::Corners(corners.collect())
    }

    fn facets(&self) -> Facets {
        match round::frustum(self.sides, self.radii, self.ends) {
            Ok(mesh) => Facets::Polyhedron {
                points: mesh.points().to_vec(),
                faces: mesh.faces().to_vec(),
            },
            Err(_) => Facets::Unknown,
        }
    }

    fn is_convex(&self) -> bool {
        true
    }

    /// The polygon of a radius has the area `sides / 2 · radius² · sin(step)`; between two heights
    /// the radius is linear (Heron of Alexandria, Metrica II 8).
    fn volume(&self) -> Option<Rounded> {
        let [a, b] = self.radii.map(Rounded::exact);
        let [bottom, top] = self.ends.map(Rounded::exact);
        let sides = Rounded::exact(f64::from(self.sides));
        let sine = Rounded::nearly(sin_deg(self.step()));
        Some((top - bottom) * Rounded::SIXTH * sides * sine * (a * a + a * b + b * b))
    }

    fn lengths(&self) -> [Vec<f64>; 3] {
        let [bottom, top] = self.ends;
        let across = self.radii.to_vec();
        [across.clone(), across, vec![bottom, top, top - bottom]]
    }
}
