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
    /// The largest tree that is compiled: how many leaves, operators, maps and tags it may
    /// have when it is written out, with shared subtrees as often as they occur. The default
    /// is 2²⁷, which takes some 40 GB.
    pub most_nodes: u64,
}

impl Default for CompileOptions {
    fn default() -> Self {
        Self { most_nodes: 1 << 27 }
    }
}
