//! `solidray render`

use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, bail};
use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum};
use image::ImageFormat;
use serde::Serialize;
use solidray::render::{
    self, Camera, Light, Look, Projection, Scheme, Style, distinct_color,
};
use solidray::{Aabb, Op, Solid};

use super::input::Reading;
use super::meter::Meter;
use super::numbers;
use super::output;
use super::pieces::{By, hex, pieces};
use super::{Answer, Global};

/// Draw a picture
///
/// The view is OpenSCAD's: without --camera the whole model from the front, the right and
/// above. `color()` is honoured; other surfaces are yellow, and green where they were cut.
#[derive(Args, Debug)]
pub(super) struct Render {
    /// The model
    file: PathBuf,
    /// The picture to write, a .png; or - for standard output
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Width and height in pixels
    #[arg(long, value_name = "W,H", default_value = "1024,768", value_parser = size, help_heading = "View")]
    imgsize: [u32; 2],
    /// Where to look from: x,y,z, turned by rx,ry,rz degrees, from distance d; or from the
    /// eye ex,ey,ez to the centre cx,cy,cz
    #[arg(long, value_name = "NUMBERS", value_parser = camera, help_heading = "View")]
    camera: Option<Camera>,
    /// o or orthogonal: parallel rays; p or perspective: rays from the eye
    #[arg(long, value_name = "o|p", value_parser = projection, default_value = "p", hide_default_value = true, help_heading = "View")]
    projection: Projection,
    /// Choose the distance so that everything is in view [default without --camera]
    #[arg(long, help_heading = "View")]
    viewall: bool,
    /// Look at the centre of the model [default without --camera]
    #[arg(long, help_heading = "View")]
    autocenter: bool,
    /// What to show of surfaces
    #[arg(long, value_enum, default_value_t = LookArg::Shaded, help_heading = "Looks")]
    look: LookArg,
    /// How many rays go through each pixel, spread evenly, for smooth edges
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=65536), help_heading = "Looks")]
    samples: u32,
    /// Where light comes from
    #[arg(long, value_enum, default_value_t = LightArg::Plain, help_heading = "Looks")]
    light: LightArg,
    /// How many rays soft light takes for each ray from the eye
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=65536), help_heading = "Looks")]
    light_rays: u32,
    /// Draw dark lines along outlines, steps and creases
    #[arg(long, help_heading = "Looks")]
    edges: bool,
    /// The colours of what has none, as OpenSCAD's schemes have them
    #[arg(long, value_name = "SCHEME", value_parser = PossibleValuesParser::new(Scheme::ALL.map(|(name, _)| name)), ignore_case = true, default_value = Scheme::ALL[0].0, help_heading = "Looks")]
    colorscheme: String,
    #[command(flatten)]
    reading: Reading,
}

#[derive(ValueEnum, Clone, Copy, Debug)]
enum LookArg {
    /// light and colours
    Shaded,
    /// directions of surfaces as red, green and blue
    Normal,
    /// near is white, far is dark
    Depth,
    /// a colour for each leaf
    Leaf,
    /// a colour for each object at the top of the model; -v and --json say which is whose
    Object,
}

#[derive(ValueEnum, Clone, Copy, Debug)]
enum LightArg {
    /// lamps that nothing stands in front of
    Plain,
    /// a lamp as wide as the sky: corners and holes are darker, and it takes longer
    Soft,
}

#[derive(Serialize)]
struct Report {
    output: String,
    width: u32,
    height: u32,
    samples: u32,
    rays: u64,
    /// The objects that are told apart by their colours.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    objects: Vec<ObjectJson>,
    seconds: Seconds,
}

#[derive(Serialize)]
struct ObjectJson {
    name: String,
    color: String,
}

#[derive(Serialize)]
struct Seconds {
    read: f64,
    compile: f64,
    trace: f64,
    write: f64,
}

/// The largest picture, in pixels.
const MOST_PIXELS: u64 = 1 << 28;

impl Render {
    pub(super) fn run(
        &self,
        global: Global,
        out: &mut dyn Write,
    ) -> anyhow::Result<Answer> {
        let to_standard_output = self.output.as_os_str() == "-";
        if !to_standard_output {
            refuse_early(&self.output)?;
        } else if global.json {
            bail!("standard output cannot take both the picture and --json");
        }
        let mut objects = Vec::new();
        let change = |solid: Solid| match self.look {
            LookArg::Object => colored(&solid, &mut objects),
            LookArg::Shaded | LookArg::Normal | LookArg::Depth | LookArg::Leaf => solid,
        };
        let loaded = self.reading.load_changed(&self.file, global, change)?.0;
        let camera = self.camera(&loaded.scene.bounds());
        let style = Style {
            look: match self.look {
                LookArg::Shaded | LookArg::Object => Look::Shaded,
                LookArg::Normal => Look::Normal,
                LookArg::Depth => Look::Depth,
                LookArg::Leaf => Look::Leaf,
            },
            scheme: Scheme::named(&self.colorscheme).unwrap_or_default(),
            samples: self.samples,
            light: match self.light {
                LightArg::Plain => Light::Plain,
                LightArg::Soft => Light::Soft { rays: self.light_rays },
            },
            edges: self.edges,
        };
        let rays = style.rays(self.imgsize);
        let start = Instant::now();
        let meter = Meter::new(global, "tracing", Some(rays));
        let picture =
            render::picture(&loaded.scene, &camera, self.imgsize, &style, &|n| {
                meter.tick(n);
            });
        drop(meter);
        let trace = start.elapsed().as_secs_f64();

        let start = Instant::now();
        let mut png = Cursor::new(Vec::new());
        picture.write_to(&mut png, ImageFormat::Png).context("the picture")?;
        if to_standard_output {
            out.write_all(png.get_ref())?;
        } else {
            output::save(&self.output, png.get_ref())?;
        }
        let write = start.elapsed().as_secs_f64();
        let (read, compile) = (loaded.read_seconds, loaded.compile_seconds);
        if global.json {
            let [width, height] = self.imgsize;
            let output = self.output.display().to_string();
            let seconds = Seconds { read, compile, trace, write };
            output::json(
                out,
                Report {
                    output,
                    width,
                    height,
                    samples: self.samples,
                    rays,
                    objects,
                    seconds,
                },
            )?;
        } else if global.verbose {
            super::report::note(&format!(
                "{rays} rays; seconds: read {read:.3}, compile {compile:.3}, trace {trace:.3}, write {write:.3}"
            ));
            for ObjectJson { name, color } in objects {
                super::report::note(&format!("{color} is {name}"));
            }
        }
        Ok(Answer::Yes)
    }

    /// The camera that was asked for, or one that shows everything.
    fn camera(&self, bounds: &Aabb) -> Camera {
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
}

/// The solid with a colour for each object at its top, and which is whose.
fn colored(solid: &Solid, names: &mut Vec<ObjectJson>) -> Solid {
    let objects = (0..).zip(pieces(solid, By::Objects));
    let colored = objects.map(|(number, (name, object))| {
        let color = distinct_color(number);
        names.push(ObjectJson { name, color: hex(color) });
        object.colored(color)
    });
    Solid::boolean(Op::Union, colored)
}

/// What would only be found out after the work.
fn refuse_early(path: &Path) -> anyhow::Result<()> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("png") => {}
        _ => bail!("{}: pictures are written as .png", path.display()),
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
        bail!("{}: there is no folder {}", path.display(), folder.display());
    }
    Ok(())
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let parts: Result<Vec<u32>, _> =
        text.split([',', 'x']).map(|n| n.trim().parse()).collect();
    match parts.as_deref() {
        Ok(&[w, h]) if w > 0 && h > 0 => {
            if u64::from(w) * u64::from(h) > MOST_PIXELS {
                return Err(format!("{w} × {h} is more than {MOST_PIXELS} pixels"));
            }
            Ok([w, h])
        }
        _ => Err(format!("`{text}` is not a width and a height, as in 800,600")),
    }
}

fn camera(text: &str) -> Result<Camera, String> {
    let numbers = numbers::list(text).map_err(|error| error.to_string())?;
    Camera::from_numbers(&numbers).map_err(|error| error.to_string())
}

fn projection(text: &str) -> Result<Projection, String> {
    match text {
        "o" | "ortho" | "orthogonal" | "orthographic" => Ok(Projection::Orthographic),
        "p" | "perspective" => Ok(Projection::Perspective),
        _ => Err(format!("`{text}` is neither o (orthogonal) nor p (perspective)")),
    }
}
