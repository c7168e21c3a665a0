//! Many rays at once: a tile of a picture, or of an integral.
//!
//! Rays of a tile meet much the same leaves. So the tile is looked at first: a [`Region`] of
//! space around a part of its rays, of which each leaf is either far away, or all around, or
//! neither. What is not decided by that is a small expression of few leaves, for that part
//! of the rays; regions are divided until it is small enough. This is how octrees of CSG
//! models are made (J. R. Woodwark, K. M. Quinlan, "Reducing the effect of complexity on volume
//! model evaluation", Computer-Aided Design 14(2), 1982; interval arithmetic as in
//! T. Duff, "Interval arithmetic and recursive subdivision for implicit functions and
//! constructive solid geometry", SIGGRAPH 1992), here for as long as a tile takes.
//!
//! Then the few leaves meet the rays, side by side in the machine's vectors, and the sorted
//! crossings are walked along as [`Tracer`] does, with the same numbers: an answer does
//! not depend on the tile that has found it. Where it might (two crossings at one `t` of the
//! ray), the tracer itself is asked.

mod block;
mod bunch;
mod chord;
mod flat;
mod known;
mod mesh;
mod meshes;
mod outline;
mod packet;
mod reach;
mod sight;
mod sighting;
mod survey;
#[cfg(test)]
mod tests;
mod tile;
mod trial;
mod walk;
mod work;

pub(crate) use bunch::{Bunch, BunchTracer, Chords, Places};
pub(super) use known::{Known, Place};
pub(crate) use tile::{SIDE, Tile, TileTracer};
