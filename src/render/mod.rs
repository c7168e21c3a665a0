//! Pictures: a camera looks at a scene, a frame holds what it sees, a look paints it.
//!
//! ```text
//! Camera ─► View ─► trace ─► Frame ─► shade ─► RgbImage
//! (numbers) (rays)          (t, leaf, face)     └─ picture: many frames, averaged
//! ```
//!
//! A [`Frame`] exists before any pixel does, so that geometry is tested without colours
//! and a new look is a function of a frame.
//!
//! # Adding a look
//!
//! In `look.rs` a variant of `Look`, its place in `Look::ALL`, and an arm each in
//! `Look::paint` and `Look::background`; in the command line's `render/mod.rs` a value
//! of `LookArg` and its arms. What colours alone can show, as `--look object` does, is only in the
//! latter: it colours the solid.

mod camera;
mod chunks;
#[cfg(feature = "image")]
mod coverage;
#[cfg(feature = "image")]
mod edges;
mod frame;
#[cfg(feature = "image")]
mod heat;
#[cfg(feature = "image")]
mod lengths;
#[cfg(feature = "image")]
mod light;
#[cfg(feature = "image")]
mod look;
#[cfg(feature = "image")]
mod picture;
#[cfg(feature = "image")]
mod scheme;
#[cfg(feature = "image")]
mod shade;
#[cfg(feature = "image")]
mod shown;
#[cfg(feature = "image")]
mod sky;
mod view;

pub use camera::{Camera, CameraError, Projection};
#[cfg(feature = "image")]
pub use coverage::coverage;
pub use frame::{Frame, trace};
#[cfg(feature = "image")]
pub use heat::{heat, heat_color, tint};
#[cfg(feature = "image")]
pub use lengths::{depth, depth_bands, thickness, thickness_bands};
#[cfg(feature = "image")]
pub use light::Light;
#[cfg(feature = "image")]
pub use look::{Look, distinct_color};
#[cfg(feature = "image")]
pub use picture::{Style, picture, picture_bands};
#[cfg(feature = "image")]
pub use scheme::Scheme;
#[cfg(feature = "image")]
pub use shade::shade;
#[cfg(feature = "image")]
pub use shown::{Shown, Translucent};
pub use view::View;
