//! The pictures of a report on its page, and what their colours mean.

use std::fmt::Write;
use std::path::Path;

use base64::prelude::{BASE64_STANDARD, Engine};
use solidray::render::tint;

use super::super::ticks::{short, ticks};
use super::pictures::{HUES_DEG, Pictures, SIZE};
use super::words::name;

/// Three figures side by side where there is room.
pub(super) fn figures(files: [&Path; 2], pictures: &Pictures) -> String {
    let [a, b, difference] = &pictures.pngs;
    let [file_a, file_b] = files.map(name);
    let legend = legend(pictures);
    let ring =
        |with_line| pictures.worst.map(|ends| ring(ends, with_line)).unwrap_or_default();
    let (on_model, on_map) = (ring(true), ring(false));
    let all = [
        (format!("<b>A</b> {file_a}"), "Picture of A", a, &on_model, ""),
        (format!("<b>B</b> {file_b}"), "Picture of B", b, &on_model, ""),
        (
            "<b>Difference</b> along the line of sight".to_owned(),
            "Map of the difference",
            difference,
            &on_map,
            legend.as_str(),
        ),
    ];
    let [width, height] = SIZE;
    let mut text = "<section class=\"pictures\">\n".to_owned();
    for (caption, alt, png, over, below) in all {
        let _ = writeln!(
            text,
            r#"<figure>
<figcaption>{caption}</figcaption>
<div class="frame"><img width="{width}" height="{height}" alt="{alt}" src="data:image/png;base64,{png}" />{over}</div>
<div class="scale">{below}</div>
</figure>"#,
            png = BASE64_STANDARD.encode(png),
        );
    }
    text + "</section>\n"
}

/// What the colours of the map mean: a bar for each side, and the numbers of both.
fn legend(pictures: &Pictures) -> String {
    let mut text = "\n".to_owned();
    let bars =
        ["only in A", "only in B"].into_iter().zip(HUES_DEG).zip(pictures.thickest);
    for ((label, hue_deg), thickest) in bars {
        let _ = writeln!(
            text,
            r#"<span>{label}</span><span class="bar" style="background:linear-gradient(to right,{})" title="at most {}"></span>"#,
            gradient(hue_deg),
            short(f64::from(thickest)),
        );
    }
    let most = pictures.most;
    let numbers: Vec<f32> = ticks(most).collect();
    // More would touch each other.
    let every = if numbers.len() > 6 { 2 } else { 1 };
    let ticks = numbers.into_iter().step_by(every).map(|number| {
        let left = 100.0 * number / most;
        format!(r#"<span style="left:{left:.2}%">{}</span>"#, short(f64::from(number)))
    });
    let ticks: String = ticks.collect();
    let _ = writeln!(text, r#"<span>thickness</span><span class="ticks">{ticks}</span>"#);
    text
}

/// The colours of a bar from nothing to the most.
fn gradient(hue_deg: f32) -> String {
    let stops = (0..=10_u8).map(|i| {
        let [r, g, b] = tint(hue_deg, f32::from(i) / 10.0);
        format!("#{r:02x}{g:02x}{b:02x}")
    });
    stops.collect::<Vec<_>>().join(",")
}

/// A ring around a stretch that is seen from one place to another, and perhaps the stretch itself.
fn ring([from, to]: [[f64; 2]; 2], with_line: bool) -> String {
    /// What lies around a stretch is to be seen too, and so is one that is hardly a pixel.
    const ROOM: f64 = 16.0;
    let [width, height] = SIZE;
    let [x, y] = [0, 1].map(|i| 0.5 * (from[i] + to[i]));
    let radius = 0.5 * (to[0] - from[0]).hypot(to[1] - from[1]) + ROOM;
    let circle = format!(r#"cx="{x:.1}" cy="{y:.1}" r="{radius:.1}""#);
    let line = match with_line {
        true => format!(
            r#"<line class="over" x1="{:.1}" y1="{:.1}" x2="{:.1}" y2="{:.1}" />"#,
            from[0], from[1], to[0], to[1]
        ),
        false => String::new(),
    };
    format!(
        r#"<svg viewBox="0 0 {width} {height}" aria-hidden="true"><circle class="under" {circle} /><circle class="over" {circle} />{line}</svg>"#
    )
}
