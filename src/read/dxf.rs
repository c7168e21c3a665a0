//! `.dxf`: closed lines of `LINE`, `ARC`, `CIRCLE` and `LWPOLYLINE`, as OpenSCAD 2021.01 takes
//! them: bulges are straight, polylines are closed, lines are joined by their ends, and what stays
//! open is nothing.

use std::collections::HashMap;

use glam::DVec2;

use super::error::{Located, ReadErrorKind};
use super::words::quoted;
use crate::angle::{cos_deg, sin_deg};
use crate::solid::Place;

/// An entity's type, layer and numbers by their codes.
#[derive(Default)]
struct Entity {
    name: Vec<u8>,
    place: Option<Place>,
    layer: Vec<u8>,
    numbers: HashMap<u32, f64>,
    corners: Vec<DVec2>,
}

/// The closed lines on a layer, or on all if it has no name, circles with `segments` of their
/// radius.
pub(super) fn read(
    bytes: &[u8],
    layer: &str,
    segments: &mut dyn FnMut(f64) -> Result<u32, Located>,
) -> Result<Vec<Vec<DVec2>>, Located> {
    let mut lines = bytes.split(|&b| b == b'\n').map(<[u8]>::trim_ascii);
    let (mut section, mut line) = (Vec::new(), 0);
    let (mut entity, mut drawing) = (Entity::default(), Drawing::default());
    while let (Some(code), Some(value)) = (lines.next(), lines.next()) {
        line += 2;
        let place = |line| Place { line, column: 1 };
        let parsed = std::str::from_utf8(code).ok().and_then(|c| c.parse::<u32>().ok());
        let Some(code) = parsed else {
            let found = quoted(code);
            return Err(Located::syntax(place(line - 1), "the code of a group", found));
        };
        match code {
            0 => {
                if section == b"ENTITIES"
                    && (layer.is_empty() || layer.as_bytes() == entity.layer)
                {
                    drawing.add(&entity, segments)?;
                }
                if value == b"ENDSEC" {
                    section.clear();
                }
                let (name, place) = (value.to_vec(), Some(place(line)));
                entity = Entity { name, place, ..Entity::default() };
            }
            2 if entity.name == b"SECTION" => section = value.to_vec(),
            8 => entity.layer = value.to_vec(),
            10..60 => {
                let number =
                    std::str::from_utf8(value).ok().and_then(|v| v.parse::<f64>().ok());
                let number = number.filter(|x| x.is_finite()).ok_or_else(|| {
                    Located::syntax(place(line), "a finite number", quoted(value))
                })?;
                entity.numbers.insert(code, number);
                if code == 20 && entity.name == b"LWPOLYLINE" {
                    entity.corners.push(DVec2::new(entity.number(10), number));
                }
            }
            _ => {}
        }
    }
    Ok(drawing.closed())
}

impl Entity {
    fn number(&self, code: u32) -> f64 {
        self.numbers.get(&code).copied().unwrap_or(0.0)
    }
}

/// Lines between points that are distinct on a coarse grid.
#[derive(Default)]
struct Drawing {
    points: Vec<DVec2>,
    found: HashMap<[i64; 2], usize>,
    lines: Vec<[usize; 2]>,
}

impl Drawing {
    fn add(
        &mut self,
        entity: &Entity,
        segments: &mut dyn FnMut(f64) -> Result<u32, Located>,
    ) -> Result<(), Located> {
        let at = |x, y| DVec2::new(entity.number(x), entity.number(y));
        match entity.name.as_slice() {
            b"LINE" => self.chain([at(10, 20), at(11, 21)]),
            b"LWPOLYLINE" => {
                let first = entity.corners.first().copied();
                self.chain(entity.corners.iter().copied().chain(first));
            }
            b"CIRCLE" | b"ARC" => {
                let radius = entity.number(40);
                let (from, to) = match entity.name.as_slice() {
                    b"CIRCLE" => (0.0, 360.0),
                    _ => (entity.number(50), entity.number(51)),
                };
                let turn = if to > from { to - from } else { to - from + 360.0 };
                let count = f64::from(segments(radius)?);
                let pieces = super::fineness::whole((count * turn / 360.0).ceil()).max(1);
                let point = |i: u32| {
                    let angle = from + turn * f64::from(i) / f64::from(pieces);
                    at(10, 20) + radius * DVec2::new(cos_deg(angle), sin_deg(angle))
                };
                self.chain((0..=pieces).map(point));
            }
            b"ELLIPSE" | b"SPLINE" | b"POLYLINE" | b"INSERT" => {
                let what = format!("{} in .dxf files", quoted(&entity.name));
                let kind = ReadErrorKind::Unsupported(what);
                return Err(Located { place: entity.place, kind });
            }
            _ => {}
        }
        Ok(())
    }

    fn chain(&mut self, points: impl IntoIterator<Item = DVec2>) {
        let mut last = None;
        for point in points {
            let this = self.point(point);
            if let Some(last) = last.filter(|&last| last != this) {
                self.lines.push([last, this]);
            }
            last = Some(this);
        }
    }

    /// The index of a point, or of one that is as good as it.
    fn point(&mut self, point: DVec2) -> usize {
        const CELLS: f64 = 1024.0;
        #[expect(clippy::cast_possible_truncation, reason = "conversion saturates")]
        let cell = (point * CELLS).round().to_array().map(|x| x as i64);
        for x in -1..=1 {
            for y in -1..=1 {
                let near = [cell[0].saturating_add(x), cell[1].saturating_add(y)];
                if let Some(&index) = self.found.get(&near) {
                    return index;
                }
            }
        }
        self.found.insert(cell, self.points.len());
        self.points.push(point);
        self.points.len() - 1
    }

    /// The closed ways along the lines, each line taken once.
    fn closed(&self) -> Vec<Vec<DVec2>> {
        let mut at: Vec<Vec<usize>> = vec![Vec::new(); self.points.len()];
        for (i, line) in self.lines.iter().enumerate() {
            line.iter().for_each(|&end| at[end].push(i));
        }
        let mut used = vec![false; self.lines.len()];
        let mut closed = Vec::new();
        for start in 0..self.lines.len() {
            let [first, mut here] = self.lines[start];
            if std::mem::replace(&mut used[start], true) {
                continue;
            }
            let mut way = vec![self.points[first]];
            while here != first {
                way.push(self.points[here]);
                // Lines that were taken once are not looked at again.
                let next = loop {
                    match at[here].pop() {
                        Some(line) if used[line] => {}
                        other => break other,
                    }
                };
                let Some(line) = next else { break };
                used[line] = true;
                let [a, b] = self.lines[line];
                here = if a == here { b } else { a };
            }
            if here == first && way.len() > 2 {
                closed.push(way);
            }
        }
        closed
    }
}
