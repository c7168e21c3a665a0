//! The numbers of a report on its page.

use solidray::measure::{Comparison, Estimate};

use super::super::output::{confidence, earned, number};

/// A table with as many digits as the text of `compare` has.
pub(super) fn table(found: &Comparison) -> String {
    let Comparison { a, b, a_minus_b, b_minus_a, difference, iou, .. } = found;
    let rows = [
        ("A", "a", a),
        ("B", "b", b),
        ("A − B, what only A has", "a_minus_b", a_minus_b),
        ("B − A, what only B has", "b_minus_a", b_minus_a),
        ("The difference, what only one of them has", "difference", difference),
        ("Intersection over union, a ratio", "iou", iou),
    ];
    let rows: String = rows.map(|(name, id, estimate)| row(name, id, estimate)).concat();
    format!(
        r#"<h2>Measures</h2>
<table>
<thead><tr><th>Volume of</th><th>Value</th><th>Interval</th><th>Confidence</th></tr></thead>
<tbody>
{rows}</tbody>
</table>
"#
    )
}

/// One measure, whose exact numbers are there for programs.
fn row(name: &str, id: &str, estimate: &Estimate) -> String {
    let Estimate { value, interval: [low, high], resolved, .. } = *estimate;
    let half_width = estimate.half_width();
    let shown = match resolved {
        true => number(value, half_width),
        false => "not resolved".to_owned(),
    };
    let interval = match (resolved, half_width > 0.0) {
        (true, false) => "–".to_owned(),
        (true, true) => {
            format!("{} to {}", earned(low, half_width), earned(high, half_width))
        }
        (false, _) if low > 0.0 => format!("{low:.3e} to {high:.3e}"),
        (false, _) => format!("at most {high:.3e}"),
    };
    let confidence = confidence(estimate).unwrap_or("exact");
    format!(
        r#"<tr id="{id}" data-value="{value}" data-low="{low}" data-high="{high}"><th>{name}</th><td>{shown}</td><td data-label="Interval">{interval}</td><td data-label="Confidence">{confidence}</td></tr>
"#
    )
}
