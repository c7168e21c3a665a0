//! Where the model is looked at from.

use clap::Args;
use solidray::Aabb;
use solidray::render::{Camera, Projection};

use super::super::numbers;

/// Options of the view; they mean what they mean in OpenSCAD.
#[derive(Args, Debug)]
pub(super) struct ViewArgs {
    /// Width and height in pixels
    #[arg(long, value_name = "W,H", default_value = "1024,768", value_parser = size, help_heading = "View")]
    pub(super) imgsize: [u32; 2],
    #[command(flatten)]
    pub(super) camera: CameraArgs,
    /// Draw so many pictures while the model turns once: OUT-000.png, OUT-001.png and so on
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000), help_heading = "View")]
    pub(super) turntable: Option<u32>,
}

/// Options of the camera.
#[derive(Args, Debug)]
pub(in super::super) struct CameraArgs {
    /// Where to look from: x,y,z, turned by rx,ry,rz degrees, from distance d; or from the
    /// eye ex,ey,ez to the centre cx,cy,cz
    #[arg(long, value_name = "NUMBERS", value_parser = camera, help_heading = "View")]
    camera: Option<Camera>,
    /// o or orthogonal: parallel rays; p or perspective: rays from the eye
    #[arg(long, value_name = "o|p", value_parser = projection, default_value = "p", help_heading = "View")]
    pub(in super::super) projection: Projection,
    /// Choose the distance so that everything is in view [default without --camera]
    #[arg(long, help_heading = "View")]
    viewall: bool,
    /// Look at the centre of the model [default without --camera]
    #[arg(long, help_heading = "View")]
    autocenter: bool,
}

/// The largest picture, in pixels.
const MOST_PIXELS: u64 = 1 << 28;
/// The widest or highest one: bands are whole tiles high, and scales as high as the picture.
const MOST_ACROSS: u32 = 1 << 16;

impl CameraArgs {
    /// The camera that was asked for, or one that shows everything.
    pub(in super::super) fn camera(&self, bounds: &Aabb) -> Camera {
        let camera = match self.camera {
            None => Camera::framing(bounds),
            Some(camera) => {
                let centered =
                    if self.autocenter { camera.autocenter(bounds) } else { camera };
                if self.viewall { centered.view_all(bounds) } else { centered }
            }
        };
        camera.with_projection(self.projection)
    }

    /// Whether it was said where the camera stands.
    pub(in super::super) fn is_placed(&self) -> bool {
        self.camera.is_some() || self.viewall || self.autocenter
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let parts: Result<Vec<u32>, _> =
        text.split([',', 'x']).map(|n| n.trim().parse()).collect();
    match parts.as_deref() {
        Ok(&[w, h]) if w > 0 && h > 0 => {
            if w.max(h) > MOST_ACROSS {
                return Err(format!(
                    "{w} × {h} is more than {MOST_ACROSS} pixels across"
                ));
            }
            if u64::from(w) * u64::from(h) > MOST_PIXELS {
                return Err(format!("{w} × {h} is more than {MOST_PIXELS} pixels"));
            }
            Ok([w, h])
        }
        _ => Err(format!("`{text}` is not a width and a height, as in 800,600")),
    }
}

/// The camera of OpenSCAD's option `--camera`.
pub(in super::super) fn camera(text: &str) -> Result<Camera, String> {
    let numbers = numbers::list(text).map_err(|error| error.to_string())?;
    Camera::from_numbers(&numbers).map_err(|error| error.to_string())
}

/// The projection of OpenSCAD's option `--projection`.
pub(in super::super) fn projection(text: &str) -> Result<Projection, String> {
    match text {
        "o" | "ortho" | "orthogonal" | "orthographic" => Ok(Projection::Orthographic),
        "p" | "perspective" => Ok(Projection::Perspective),
        _ => Err(format!("`{text}` is neither o (orthogonal) nor p (perspective)")),
    }
}
