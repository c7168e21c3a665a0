//! What a caller can choose when a solid is compiled.

/// How to compile.
///
/// ```
/// use solidray::{CompileError, CompileOptions, Scene, Solid};
///
/// let options = CompileOptions { most_nodes: 2, ..CompileOptions::default() };
/// let pair = Solid::ball(1.0) + Solid::cylinder(0.5, 3.0);
/// let refused = Scene::compile_with(&pair, &options);
/// assert_eq!(refused.unwrap_err(), CompileError::TooLarge { most_nodes: 2 });
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CompileOptions {
    /// Up to what distance surfaces are made one: a length in model units, zero by default.
    ///
    /// Surfaces that coincide but for rounding are always made one. A file that was printed
    /// with few digits has some that do not, though they were meant to. With a weld, planes
    /// and curved walls, facing either way, become one if their leaves touch and they are
    /// nowhere on the smaller leaf farther apart than this, measured square to the surface,
    /// never along a ray. They take the place of that of the largest leaf, and no surface
    /// moves farther than this. Where one would have to, because surfaces form a chain of
    /// which the ends are too far apart, the solid is refused. So it is if two faces of one
    /// leaf would become one: choose less than the thickness of the thinnest leaf that
    /// touches another. Faces of meshes are not welded.
    ///
    /// [`Scene::welds`](crate::Scene::welds) says what was done, and
    /// [`Scene::near_misses`](crate::Scene::near_misses) which weld would do more.
    pub weld: f64,
    /// The largest tree that is compiled: how many leaves, operators, maps and tags it may
    /// have when it is written out, with shared subtrees as often as they occur. The default
    /// is 2²⁷, which takes some 40 GB.
    pub most_nodes: u64,
}

impl Default for CompileOptions {
    fn default() -> Self {
        Self { weld: 0.0, most_nodes: 1 << 27 }
    }
}
