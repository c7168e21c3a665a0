//! What `measure` prints for people.

use std::io::Write;

use super::super::Global;
use super::super::output::{number, uncertain_in_words};
use super::json::{BodyJson, PropertiesJson, QuantityJson, Report};

pub(super) fn print(
    report: &Report,
    global: Global,
    out: &mut dyn Write,
) -> anyhow::Result<()> {
    if let Some(found) = &report.whole.properties {
        properties(found, global, out)?;
    }
    if let Some(mass) = &report.mass {
        writeln!(out, "\nmass       {}", in_words_if(mass.body.is_some(), &mass.mass))?;
        if let Some(found) = &mass.body {
            body(found, "of mass, ", out)?;
        }
    }
    if !report.parts.is_empty() {
        writeln!(out, "\n{}s, each by itself", report.by.noun())?;
        let name = |name: &Option<String>| name.clone().unwrap_or_default();
        let width =
            report.parts.iter().map(|part| name(&part.name).chars().count()).max();
        for part in &report.parts {
            let Some(found) = &part.properties else { continue };
            let volume = in_words_if(found.resolved, &found.volume);
            let label = format!("{:w$}", name(&part.name), w = width.unwrap_or(0));
            match part.density {
                Some(density) => {
                    writeln!(out, "  {label}  volume {volume}, density {density}")?;
                }
                None => writeln!(out, "  {label}  volume {volume}")?,
            }
        }
        if let Some(shared) = shared(report) {
            writeln!(out, "  they overlap: {shared} is counted more than once")?;
        }
    }
    writeln!(out, "\nIntervals are 95 %.")?;
    if global.verbose {
        writeln!(out, "seconds    {:.3}", report.seconds)?;
    }
    Ok(())
}

fn properties(
    found: &PropertiesJson,
    global: Global,
    out: &mut dyn Write,
) -> anyhow::Result<()> {
    writeln!(out, "volume     {}", in_words_if(found.resolved, &found.volume))?;
    writeln!(out, "surface    {}", in_words_if(found.resolved, &found.area))?;
    if let Some(found) = &found.body {
        body(found, "", out)?;
    }
    let corner = |p: [f64; 3]| format!("{:.6}, {:.6}, {:.6}", p[0], p[1], p[2]);
    if let Some(reached) = &found.reached {
        writeln!(out, "reaches    {}", corner(reached.min))?;
        writeln!(out, "           {}", corner(reached.max))?;
    }
    if let Some(bounds) = &found.bounds {
        writeln!(out, "within     {}", corner(bounds.min))?;
        writeln!(out, "           {}", corner(bounds.max))?;
    }
    if global.verbose {
        writeln!(out, "method     {}", found.method)?;
        writeln!(out, "rays       {}", found.rays)?;
        writeln!(out, "spans      {}", uncertain_in_words(found.spans, found.uncertain))?;
    }
    Ok(())
}

fn body(body: &BodyJson, of: &str, out: &mut dyn Write) -> anyhow::Result<()> {
    let [x, y, z] = &body.centroid;
    let (x, y, z) = (in_words(x), in_words(y), in_words(z));
    writeln!(out, "centroid   {x}, {y}, {z}")?;
    let m = &body.inertia;
    let row = |a: &QuantityJson, b: &QuantityJson, c: &QuantityJson| {
        format!("{}, {}, {}", in_words(a), in_words(b), in_words(c))
    };
    writeln!(out, "inertia    {of}about the centroid")?;
    writeln!(out, "  xx yy zz {}", row(&m[0][0], &m[1][1], &m[2][2]))?;
    writeln!(out, "  xy yz zx {}", row(&m[0][1], &m[1][2], &m[2][0]))?;
    for (i, principal) in body.principal.iter().enumerate() {
        // A zero that has a sign is added to one that has none.
        let [x, y, z] = principal.axis.map(|x| (1e4 * x).round() / 1e4 + 0.0);
        let label = if i == 0 { "principal" } else { "         " };
        writeln!(
            out,
            "{label}  {} about {x:.4}, {y:.4}, {z:.4} ± {:.2}°",
            in_words(&principal.moment),
            principal.angle.to_degrees()
        )?;
    }
    Ok(())
}

/// A number that was resolved.
fn in_words(quantity: &QuantityJson) -> String {
    number(quantity.value, quantity.half_width().unwrap_or(f64::INFINITY))
}

/// A number that was resolved or not.
fn in_words_if(resolved: bool, quantity: &QuantityJson) -> String {
    match quantity.interval[1] {
        _ if resolved => in_words(quantity),
        Some(0.0) => "0".to_owned(),
        high => {
            let low = quantity.interval[0].filter(|low| *low > 0.0);
            let least = low.map(|low| format!("at least {low:.3e}"));
            let most = high.map(|high| format!("at most {high:.3e}"));
            let bounds: Vec<String> = least.into_iter().chain(most).collect();
            let colon = if bounds.is_empty() { "" } else { ": " };
            format!("not resolved{colon}{}", bounds.join(", "))
        }
    }
}

/// By how much the parts are more than the whole, where that is more than chance.
fn shared(report: &Report) -> Option<String> {
    let all = |of: fn(&QuantityJson) -> Option<f64>| -> Option<Vec<f64>> {
        let volumes = report.parts.iter().map(|p| of(&p.properties.as_ref()?.volume));
        volumes.collect()
    };
    let whole = &report.whole.properties.as_ref()?.volume;
    let more = all(|q| Some(q.value))?.iter().sum::<f64>() - whole.value;
    let half_widths = all(QuantityJson::half_width)?.into_iter();
    let half_width = half_widths.fold(whole.half_width()?, f64::hypot);
    (more > 2.0 * half_width).then(|| number(more, half_width))
}
