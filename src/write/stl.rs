//! Binary stereolithography, `.stl`.

use glam::DVec3;

use crate::mesh::Mesh;

/// A file with a mesh whose coordinates are numbers of single precision.
///
/// The header does not begin with `solid`, by which some programs know text.
pub(super) fn bytes(mesh: &Mesh) -> Vec<u8> {
    /// What fills the first 80 bytes.
    const HEADER: &[u8; 80] =
        b"Binary STL by solidray                                                          ";
    /// Bytes of a triangle.
    const TRIANGLE: usize = 50;
    let count = mesh.faces().len();
    let mut out = Vec::with_capacity(HEADER.len() + 4 + TRIANGLE * count);
    out.extend(HEADER);
    out.extend(u32::try_from(count).unwrap_or(u32::MAX).to_le_bytes());
    for face in 0..count {
        let corners = mesh.corners(face);
        let [a, b, c] = corners;
        point(&mut out, (b - a).cross(c - a).normalize_or_zero());
        corners.into_iter().for_each(|corner| point(&mut out, corner));
        out.extend([0; 2]);
    }
    out
}

fn point(out: &mut Vec<u8>, p: DVec3) {
    for x in p.to_array() {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "the format has no other numbers"
        )]
        let x = x as f32;
        out.extend(x.to_le_bytes());
    }
}
