//! `surface`.

use std::io::Cursor;
use std::path::Path;

use glam::{DVec2, DVec3};

use super::super::error::{Located, ReadErrorKind};
use super::super::faces::{Faces, Points};
use super::super::words::Words;
use super::arguments::Call;
use super::evaluate::Reading;
use super::file;
use super::import::is_missing;
use super::node::Shape;
use crate::solid::Solid;

/// Heights over the points of a grid, row by row from y = 0.
struct Heights {
    columns: usize,
    rows: usize,
    heights: Vec<f64>,
    /// The lowest of those that the file names.
    lowest: f64,
}

/// The solid under heights from a text or a picture: at each cell four triangles around its middle,
/// which has the mean height, and a bottom at 0, or 1 below the lowest height if that is lower.
pub(super) fn surface(
    call: &Call<'_>,
    _: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let Some(name) = call.text("file")? else { return Ok(Shape::Empty) };
    let (center, invert) = (call.truth("center")?, call.truth("invert")?);
    let path = file::path(&name, reading.folder, reading.options)
        .map_err(|kind| Located::at(call.place(), kind));
    let import = |path: &Path, error: Located| {
        let error = ReadErrorKind::Import(Box::new(error.named(path)));
        Located::at(call.place(), error)
    };
    let loaded = path.and_then(|path| match reading.budget.load(&path) {
        Ok(bytes) => Ok((path, bytes)),
        Err(kind) => Err(import(&path, Located::nowhere(kind))),
    });
    let (path, bytes) = match loaded {
        Err(error) if name.is_empty() || is_missing(&error) => {
            reading.leave_out(error, call.place());
            return Ok(Shape::Empty);
        }
        loaded => loaded?,
    };
    let import = |error| import(&path, error);
    let mut count = |columns: usize, rows: usize| {
        let cells = (columns as u64).saturating_mul(rows as u64);
        reading.count_facets(cells.saturating_mul(4), call.place())
    };
    let read = if bytes.starts_with(b"\x89PNG") {
        let [columns, rows] = size(&bytes).map_err(import)?;
        count(columns, rows)?;
        picture(&bytes, [columns, rows], invert).map_err(import)?
    } else {
        let [columns, rows] = extent(&bytes);
        count(columns, rows)?;
        matrix(&bytes, [columns, rows]).map_err(import)?
    };
    if read.columns < 2 || read.rows < 2 {
        return Ok(Shape::Empty);
    }
    let built = under(&read, center)?.build().map_err(|e| e.or_at(call.place()))?;
    Ok(Shape::Solid(Solid::mesh(built.mesh).placed(call.place())))
}

/// The lines of a text that are neither empty nor comments.
fn lines(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    let lines = bytes.split(|&b| b == b'\n').map(<[u8]>::trim_ascii);
    lines.filter(|line| !line.is_empty() && line[0] != b'#')
}

/// The most numbers on a line of a text, and how many lines have some.
fn extent(bytes: &[u8]) -> [usize; 2] {
    let count = |line: &[u8]| {
        line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).count()
    };
    lines(bytes)
        .fold([0, 0], |[columns, rows], line| [columns.max(count(line)), rows + 1])
}

/// The heights that a text names; what is missing at the ends of lines is 0.
fn matrix(bytes: &[u8], [columns, rows]: [usize; 2]) -> Result<Heights, Located> {
    let mut heights = vec![0.0; columns * rows];
    let (mut words, mut row, mut lowest) = (Words::new(bytes, None), 0, f64::INFINITY);
    while let Some(first) = words.next() {
        if first.text.starts_with(b"#") {
            words.skip_line();
            continue;
        }
        let (mut word, mut column) = (Some(first), 0);
        while let Some(this) = word {
            let height = this.number()?;
            if !height.is_finite() {
                return Err(this.unexpected("a finite number"));
            }
            if let Some(place) = heights.get_mut(row * columns + column) {
                *place = height;
            }
            lowest = lowest.min(height);
            column += 1;
            word = words.next_on_line();
        }
        row += 1;
    }
    Ok(Heights { columns, rows, heights, lowest })
}

fn fault(error: impl Into<std::io::Error>) -> Located {
    Located::nowhere(ReadErrorKind::Io(error.into()))
}

/// The size of a picture, before its pixels take any memory.
fn size(bytes: &[u8]) -> Result<[usize; 2], Located> {
    let reader = png::Decoder::new(Cursor::new(bytes)).read_info().map_err(fault)?;
    Ok([reader.info().width, reader.info().height].map(|n| n as usize))
}

/// The brightness of a picture from 0 to 100, its last row at y = 0.
fn picture(
    bytes: &[u8],
    [columns, rows]: [usize; 2],
    invert: bool,
) -> Result<Heights, Located> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(fault)?;
    let room = reader.output_buffer_size().unwrap_or(0);
    let mut pixels = vec![0; room];
    reader.next_frame(&mut pixels).map_err(fault)?;
    let channels = reader.output_color_type().0.samples();
    let brightness = |pixel: &[u8]| {
        let [r, g, b] = match *pixel {
            [r, g, b] | [r, g, b, _] => [r, g, b],
            [grey, ..] => [grey; 3],
            [] => [0; 3],
        }
        .map(f64::from);
        let bright = 0.2126 * r + 0.7152 * g + 0.0722 * b;
        100.0 / 255.0 * if invert { 1.0 - bright } else { bright }
    };
    let rows_of_pixels = pixels.chunks_exact(columns * channels);
    let heights: Vec<f64> = rows_of_pixels
        .rev()
        .flat_map(|row| row.chunks_exact(channels))
        .map(brightness)
        .collect();
    let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
    Ok(Heights { columns, rows, heights, lowest })
}

/// The faces around what is under the heights.
fn under(read: &Heights, center: bool) -> Result<Faces, Located> {
    let Heights { columns, rows, ref heights, lowest } = *read;
    let bottom = (lowest - 1.0).min(0.0);
    let least = if center {
        -0.5 * DVec2::new((columns - 1) as f64, (rows - 1) as f64)
    } else {
        DVec2::ZERO
    };
    // Where the top is at the bottom, one point is both.
    let mut points = Points::default();
    let mut faces = Faces::default();
    let mut push = |corners: &[u32]| {
        let mut corners = corners.to_vec();
        corners.dedup();
        if corners.first() == corners.last() {
            corners.pop();
        }
        if corners.len() > 2 {
            faces.push(corners);
        }
    };
    let height =
        |[x, y]: [usize; 2]| heights.get(y * columns + x).copied().unwrap_or(0.0);
    let at =
        |[x, y]: [usize; 2], z: f64| (least + DVec2::new(x as f64, y as f64)).extend(z);
    for y in 1..rows {
        for x in 1..columns {
            let corners = [[x - 1, y - 1], [x, y - 1], [x, y], [x - 1, y]];
            let mean = corners.map(height).iter().sum::<f64>() / 4.0;
            let middle = at([x, y], mean) - DVec3::new(0.5, 0.5, 0.0);
            let middle = points.add(middle)?;
            let mut ring = [0; 4];
            for (index, corner) in ring.iter_mut().zip(corners) {
                *index = points.add(at(corner, height(corner)))?;
            }
            for i in 0..4 {
                push(&[ring[i], ring[(i + 1) % 4], middle]);
            }
        }
    }
    // Around the rim, counter-clockwise from above.
    let (right, far) = (columns - 1, rows - 1);
    let rim = (0..right).map(|x| [x, 0]);
    let rim = rim.chain((0..far).map(|y| [right, y]));
    let rim = rim.chain((0..right).map(|x| [right - x, far]));
    let rim: Vec<[usize; 2]> = rim.chain((0..far).map(|y| [0, far - y])).collect();
    let mut floor = Vec::with_capacity(rim.len());
    for (i, &here) in rim.iter().enumerate() {
        let next = rim[(i + 1) % rim.len()];
        let low = [points.add(at(here, bottom))?, points.add(at(next, bottom))?];
        let high =
            [points.add(at(here, height(here)))?, points.add(at(next, height(next)))?];
        push(&[low[0], low[1], high[1], high[0]]);
        floor.push(low[0]);
    }
    floor.reverse();
    push(&floor);
    faces.points = points.finish();
    Ok(faces)
}
