//! POV-Ray: a process, told the scene and the camera in its own language.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use glam::{DAffine3, DMat3, DVec3};
use solidray::Op;
use solidray::primitive::{Cuboid, Primitive, Profile, Quadric};
use solidray::render::View;

use crate::clock::child_seconds;
use crate::part::{Part, radius_at};

/// The scene with an orthographic camera that sees what a square view shows.
pub fn source(part: &Part, view: &View, center: DVec3, half: f64) -> String {
    let [right, up, forward] = view.axes();
    let eye = center - 2.0 * half * forward;
    let [at, dir, right, up, light] =
        [eye, forward, 2.0 * half * right, 2.0 * half * up, eye + 10.0 * half * up]
            .map(vector);
    let mut text = format!(
        "#version 3.7; global_settings {{ assumed_gamma 1 max_trace_level 5 }}\n\
         camera {{ orthographic location {at} direction {dir} right {right} up {up} }}\n\
         light_source {{ {light} rgb 1 shadowless }}\n\
         #default {{ pigment {{ rgb 0.8 }} finish {{ ambient 0.2 diffuse 0.8 }} }}\n"
    );
    write_part(part, &mut text);
    text
}

/// The user time in seconds for a picture of `size` pixels a side, reading the scene
/// included.
pub fn seconds(source: &Path, size: u32) -> Result<f64> {
    let mut povray = Command::new("povray");
    povray
        .arg(format!("+I{}", source.display()))
        .args([format!("+W{size}"), format!("+H{size}")])
        .args(["-D", "-F", "-A", "-GA", "+WT1"])
        .env("HOME", source.parent().unwrap_or(source))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    let (status, seconds) = child_seconds(|| povray.status())?;
    ensure!(status.context("POV-Ray does not start")?.success(), "POV-Ray failed");
    Ok(seconds)
}

/// Writes the source where it can be read.
pub fn save(text: &str, folder: &Path) -> Result<std::path::PathBuf> {
    let path = folder.join("scene.pov");
    fs::write(&path, text)?;
    Ok(path)
}

/// What it calls itself.
pub fn version() -> Option<String> {
    let said = Command::new("povray").arg("--version").output().ok()?;
    let text = [said.stdout, said.stderr].concat();
    let text = String::from_utf8_lossy(&text).into_owned();
    text.lines().find(|line| line.starts_with("POV-Ray")).map(str::to_owned)
}

fn write_part(part: &Part, text: &mut String) {
    match part {
        Part::Leaf(primitive, map) => text.push_str(&leaf(primitive, map)),
        Part::Boolean(op, parts) => {
            text.push_str(match op {
                Op::Union => "union {\n",
                Op::Intersection => "intersection {\n",
                Op::Difference => "difference {\n",
            });
            for part in parts {
                write_part(part, text);
            }
            text.push_str("}\n");
        }
    }
}

/// A leaf, by points in the world where nothing stretches it: POV-Ray is faster so.
fn leaf(primitive: &Primitive, map: &DAffine3) -> String {
    let DMat3 { x_axis, y_axis, z_axis } = map.matrix3;
    let stiff =
        (map.matrix3.transpose() * map.matrix3).abs_diff_eq(DMat3::IDENTITY, 1e-12);
    let (at, stretch) = if stiff {
        (*map, String::new())
    } else {
        let numbers = [x_axis, y_axis, z_axis, map.translation].map(|v| {
            let [x, y, z] = v.to_array();
            format!("{x:e},{y:e},{z:e}")
        });
        (DAffine3::IDENTITY, format!(" matrix <{}>", numbers.join(",")))
    };
    let mut text = String::new();
    let written = match *primitive {
        Primitive::Cuboid(Cuboid { min, max }) if at.matrix3 == DMat3::IDENTITY => {
            let [min, max] = [min, max].map(|p| vector(at.translation + p));
            write!(text, "box {{ {min}, {max}{stretch} }}")
        }
        Primitive::Quadric(Quadric { profile: Profile::Ball { radius }, .. }) => {
            let center = vector(at.translation);
            write!(text, "sphere {{ {center}, {radius:e}{stretch} }}")
        }
        Primitive::Quadric(Quadric { profile, bottom, top }) => {
            let [foot, head] =
                [bottom, top].map(|z| vector(at.transform_point3(z * DVec3::Z)));
            match [bottom, top].map(|z| radius_at(&profile, z)) {
                [low, high] if low == high => {
                    write!(text, "cylinder {{ {foot}, {head}, {low:e}{stretch} }}")
                }
                [low, high] => {
                    write!(text, "cone {{ {foot}, {low:e}, {head}, {high:e}{stretch} }}")
                }
            }
        }
        _ => panic!("POV-Ray is not told of {primitive:?}"),
    };
    written.expect("a string takes all");
    text.push('\n');
    text
}

fn vector(v: DVec3) -> String {
    let [x, y, z] = v.to_array();
    format!("<{x:e},{y:e},{z:e}>")
}
