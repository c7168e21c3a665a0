//! `solidray render`

mod cut;
mod draw;
mod encode;
mod layers;
mod numbers;
mod scale;
mod target;
mod view;

use std::io::Write;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use anyhow::bail;
use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum};
use serde::Serialize;
use solidray::render::{
    Camera, Light, Look, Scheme, Shown, Style, Translucent, distinct_color,
};
use solidray::{Aabb, Color, Op, Scene, Solid};

use super::input::{Reading, warn_if_empty};
use super::meter::Meter;
use super::output;
use super::pieces::{By, hex, pieces};
use super::watch::watch;
use super::{Answer, Global};
use cut::Cut;
use draw::{Drawing, Format, Kind};
use layers::{Layers, MOST, glass};
use numbers::joined;
use target::Target;
use view::ViewArgs;

pub(super) use view::{CameraArgs, camera, projection};

/// Draw a picture
///
/// The view is OpenSCAD's: without --camera the whole model from the front, the right and
/// above. `color()` is honoured; other surfaces are yellow, and green where they were cut.
#[derive(Args, Debug)]
pub(super) struct Render {
    /// The model
    file: PathBuf,
    /// The picture to write, a .png; or - for standard output. Depths and thicknesses are written
    /// as 32-bit numbers where it is a .tiff
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    view: ViewArgs,
    /// Cut the model open: z=3 takes away what is on the viewer's side of that plane, A,B,C,D leaves what
    /// has Ax + By + Cz ≤ D. May be given several times; the faces of cuts are hatched
    #[arg(long, value_name = "PLANE", value_parser = Cut::parse, allow_hyphen_values = true, help_heading = "View")]
    cut: Vec<Cut>,
    /// What to show of surfaces
    #[arg(long, value_enum, default_value_t = LookArg::Shaded, help_heading = "Looks")]
    look: LookArg,
    /// How many rays go through each pixel, spread evenly, for smooth edges
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=65536), help_heading = "Looks")]
    samples: u32,
    /// Where light comes from
    #[arg(long, value_enum, default_value_t = LightArg::Plain, help_heading = "Looks")]
    light: LightArg,
    /// How many rays soft light takes for each ray from the eye: with few, shadows have steps
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..=65536), help_heading = "Looks")]
    light_rays: u32,
    /// How many bits a pixel of depths or thicknesses has in a .png: 16 are grey, and the comment in the
    /// file says what they mean in this picture
    #[arg(long, value_enum, default_value_t = BitsArg::Eight, help_heading = "Looks")]
    bits: BitsArg,
    /// Draw dark lines along outlines, steps and creases
    #[arg(long, help_heading = "Looks")]
    edges: bool,
    /// The colours of what has none, as OpenSCAD's schemes have them
    #[arg(long, value_name = "SCHEME", value_parser = PossibleValuesParser::new(Scheme::ALL.map(|(name, _)| name)), ignore_case = true, default_value = Scheme::ALL[0].0, help_heading = "Looks")]
    colorscheme: String,
    /// Draw all colours opaque, and not what % and # mark, as all looks but `shaded` do
    #[arg(long, help_heading = "Looks")]
    opaque: bool,
    /// Draw again whenever the file changes, or a model or drawing in its folder, until Ctrl-C
    #[arg(long)]
    watch: bool,
    #[command(flatten)]
    reading: Reading,
}

#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
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
    /// how much of the model the line of sight passes through, with a scale
    Thickness,
}

#[derive(ValueEnum, Clone, Copy, Debug)]
enum LightArg {
    /// lamps that nothing stands in front of
    Plain,
    /// a lamp as wide as the sky: corners and holes are darker, and it takes longer
    Soft,
}

#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
enum BitsArg {
    #[value(name = "8")]
    Eight,
    #[value(name = "16")]
    Sixteen,
}

#[derive(Serialize)]
struct Report {
    /// The first of them, if there are several.
    output: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pictures: Option<u32>,
    width: u32,
    height: u32,
    samples: u32,
    rays: u64,
    /// The objects that are told apart by their colours.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    objects: Vec<ObjectJson>,
    /// The least and the largest of the numbers that were found, in all pictures.
    #[serde(skip_serializing_if = "Option::is_none")]
    range: Option<[f32; 2]>,
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

impl Render {
    pub(super) fn run(
        &self,
        global: Global,
        out: &mut dyn Write,
    ) -> anyhow::Result<Answer> {
        let target = Target::new(&self.output, self.view.turntable)?;
        if target.is_standard_output() && global.json {
            bail!("standard output cannot take both the picture and --json");
        }
        let is_of_numbers = matches!(self.look, LookArg::Depth | LookArg::Thickness);
        if target.takes_numbers() && !is_of_numbers {
            bail!("only --look depth and --look thickness are written as .tiff");
        }
        if self.bits == BitsArg::Sixteen {
            if !is_of_numbers {
                bail!("only --look depth and --look thickness have 16 bits");
            }
            if target.takes_numbers() {
                bail!("numbers in a .tiff have 32 bits: --bits 16 is for a .png");
            }
        }
        if !self.watch {
            return self.drawn(&target, global, out);
        }
        if self.file.as_os_str() == "-" || target.is_standard_output() {
            bail!("--watch needs a file to read and a file to write, not -");
        }
        watch(&self.file, || {
            self.drawn(&target, global, out)?;
            if !global.quiet {
                let output = self.output.display();
                super::report::note(&format!("{output} is drawn; Ctrl-C ends"));
            }
            Ok(out.flush()?)
        })
    }

    /// Draws all pictures once.
    fn drawn(
        &self,
        target: &Target,
        global: Global,
        out: &mut dyn Write,
    ) -> anyhow::Result<Answer> {
        let start = Instant::now();
        let is_seen_through = self.look == LookArg::Shaded && !self.opaque;
        let model = match is_seen_through {
            true => self.reading.read_marked(&self.file, global)?,
            false => self.reading.read(&self.file, global)?,
        };
        let read = start.elapsed().as_secs_f64();

        let start = Instant::now();
        let mut objects = Vec::new();
        let solid = match self.look {
            LookArg::Object => colored(&model.solid, &mut objects),
            LookArg::Shaded
            | LookArg::Normal
            | LookArg::Depth
            | LookArg::Leaf
            | LookArg::Thickness => model.solid,
        };
        let whole = self.compile(&solid)?;
        warn_if_empty(&self.file, &whole, global);
        let glass = if is_seen_through { glass(&whole) } else { Vec::new() };
        let layers = Layers::new(solid, &glass, model.marks);
        if layers.too_many > 0 && !global.quiet {
            super::report::note(&format!(
                "warning: {}: {MOST} colours are seen through, {} more are drawn as if they were opaque",
                self.file.display(),
                layers.too_many
            ));
        }
        let opaque = if glass.is_empty() { whole } else { self.compile(&layers.opaque)? };
        let compile = |solid: &Solid| self.compile(solid);
        let leave_out = |error| {
            if !global.quiet {
                let what = "what `%` or `#` marks is left out";
                super::report::note(&format!("warning: {error:#}; {what}"));
            }
        };
        let mut scenes = Scenes::new(opaque, &layers, compile, leave_out)?;
        let camera = self.view.camera.camera(&scenes.bounds());
        if self.is_cut() {
            let view = camera.view(self.view.imgsize, &scenes.bounds());
            let [_, _, forward] = view.axes();
            let cut = |solid: Solid| {
                self.cut.iter().fold(solid, |solid, cut| cut.applied(&solid, forward))
            };
            let layers = layers.changed(cut);
            let opaque = compile(&layers.opaque)?;
            scenes = Scenes::new(opaque, &layers, compile, |_| ())?;
        } else {
            drop(layers);
        }
        let compile = start.elapsed().as_secs_f64();

        let (mut trace, mut write, mut range) = (0.0, 0.0, None);
        let pictures = self.view.turntable.unwrap_or(1);
        let translucent = scenes.translucent();
        let shown = Shown { solid: &scenes.opaque, translucent: &translucent };
        let rays = self.rays(target, translucent.len()).saturating_mul(pictures.into());
        let meter = Meter::new(global, "tracing", Some(rays));
        for index in 0..pictures {
            let start = Instant::now();
            let mut picture = Drawing {
                style: self.style(),
                size: self.view.imgsize,
                camera: turned(camera, index, pictures),
                numbers: self.numbers(target),
                format: self.format(target),
                folder: target.folder(),
                traced: Duration::ZERO,
                range: None,
            };
            target.write(index, |file| picture.draw(shown, &meter, file), out)?;
            range = picture.range.into_iter().chain(range).reduce(joined);
            let seconds = picture.traced.as_secs_f64();
            trace += seconds;
            write += start.elapsed().as_secs_f64() - seconds;
        }
        drop(meter);

        let seconds = Seconds { read, compile, trace, write };
        if global.json {
            let [width, height] = self.view.imgsize;
            let report = Report {
                output: target.name(0).display().to_string(),
                pictures: self.view.turntable,
                width,
                height,
                samples: self.samples,
                rays,
                objects,
                range,
                seconds,
            };
            output::json(out, report)?;
        } else if global.verbose {
            let Seconds { read, compile, trace, write } = seconds;
            super::report::note(&format!(
                "{rays} rays; seconds: read {read:.3}, compile {compile:.3}, trace {trace:.3}, write {write:.3}"
            ));
            if let Some([least, most]) = range {
                super::report::note(&format!("from {least} to {most}"));
            }
            for ObjectJson { name, color } in objects {
                super::report::note(&format!("{color} is {name}"));
            }
        }
        Ok(Answer::Yes)
    }

    fn is_cut(&self) -> bool {
        !self.cut.is_empty()
    }

    fn compile(&self, solid: &Solid) -> anyhow::Result<Scene> {
        Ok(self.reading.compile(&self.file, solid)?)
    }

    fn style(&self) -> Style {
        Style {
            look: match self.look {
                LookArg::Normal => Look::Normal,
                LookArg::Depth => Look::Depth,
                LookArg::Leaf => Look::Leaf,
                LookArg::Shaded | LookArg::Object | LookArg::Thickness => Look::Shaded,
            },
            scheme: Scheme::named(&self.colorscheme).unwrap_or_default(),
            samples: self.samples,
            light: match self.light {
                LightArg::Plain => Light::Plain,
                LightArg::Soft => Light::Soft { rays: self.light_rays },
            },
            edges: self.edges,
            hatch: self.is_cut(),
        }
    }

    /// The numbers that are found before any colour, if there are any.
    fn numbers(&self, target: &Target) -> Option<Kind> {
        let are_wanted = target.takes_numbers() || self.bits == BitsArg::Sixteen;
        match self.look {
            LookArg::Thickness => Some(Kind::Thickness),
            LookArg::Depth if are_wanted => Some(Kind::Depth),
            LookArg::Shaded
            | LookArg::Normal
            | LookArg::Depth
            | LookArg::Leaf
            | LookArg::Object => None,
        }
    }

    fn format(&self, target: &Target) -> Format {
        match self.bits {
            _ if target.takes_numbers() => Format::Tiff,
            BitsArg::Eight => Format::Png,
            BitsArg::Sixteen => Format::Png16,
        }
    }

    /// How many rays from the eye one picture takes.
    fn rays(&self, target: &Target, translucent: usize) -> u64 {
        let [width, height] = self.view.imgsize.map(u64::from);
        match self.numbers(target) {
            Some(Kind::Thickness) => width * height * u64::from(self.samples),
            Some(Kind::Depth) => width * height,
            None => self.style().rays(self.view.imgsize, translucent),
        }
    }
}

/// The scenes of the layers of a model.
struct Scenes {
    opaque: Scene,
    translucent: Vec<(Scene, Color)>,
}

impl Scenes {
    /// Marks that cannot be compiled are no reason not to show the model.
    fn new(
        opaque: Scene,
        layers: &Layers,
        compile: impl Fn(&Solid) -> anyhow::Result<Scene>,
        leave_out: impl Fn(anyhow::Error),
    ) -> anyhow::Result<Self> {
        let mut translucent = Vec::new();
        for (solid, color) in &layers.translucent {
            translucent.push((compile(solid)?, *color));
        }
        for (solid, color) in &layers.marks {
            match compile(solid) {
                Ok(scene) => translucent.push((scene, *color)),
                Err(error) => leave_out(error),
            }
        }
        Ok(Self { opaque, translucent })
    }

    fn translucent(&self) -> Vec<Translucent<'_>> {
        let each = self.translucent.iter();
        each.map(|(scene, color)| Translucent { scene, color: *color }).collect()
    }

    /// The bounds of all of them.
    fn bounds(&self) -> Aabb {
        let translucent = &self.translucent();
        Shown { solid: &self.opaque, translucent }.bounds()
    }
}

/// A camera that has gone so far around the model.
fn turned(camera: Camera, index: u32, pictures: u32) -> Camera {
    let mut rotation_deg = camera.rotation_deg;
    // The model turns to the right, as on a turntable: the camera goes the other way.
    rotation_deg.z -= 360.0 * f64::from(index) / f64::from(pictures);
    Camera { rotation_deg, ..camera }
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
