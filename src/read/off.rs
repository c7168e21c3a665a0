//! Geomview's `.off`: points and faces. Colours after faces are skipped; the variants
//! with colours, normals or more dimensions at points (`COFF`, `NOFF`, `4OFF` …) are not
//! read.

use glam::DVec3;

use super::error::{Located, ReadErrorKind};
use super::faces::Faces;
use super::words::Words;

pub(super) fn read(text: &[u8]) -> Result<Faces, Located> {
    let mut words = Words::new(text, Some(b'#'));
    match words.next() {
        Some(word) if word.text == b"OFF" => {}
        Some(word) if word.text.ends_with(b"OFF") => {
            let what = format!("the format {}", super::words::quoted(word.text));
            return Err(Located::at(word.place, ReadErrorKind::Unsupported(what)));
        }
        Some(word) => return Err(word.unexpected("`OFF`")),
        None => return Err(words.ended("`OFF`")),
    }
    let (points, faces) = (words.count()?, words.count()?);
    words.count()?; // edges, which nobody needs

    // Counts are promises: memory grows with what is there.
    let mut read = Faces::default();
    for _ in 0..points {
        let point = [words.number()?, words.number()?, words.number()?];
        read.points.push(DVec3::from_array(point));
    }
    let mut corners = Vec::new();
    for _ in 0..faces {
        corners.clear();
        for _ in 0..words.count()? {
            corners.push(words.count()?);
        }
        words.skip_line();
        read.push(corners.iter().copied());
    }
    Ok(read)
}
