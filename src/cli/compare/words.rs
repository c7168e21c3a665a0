//! Names and numbers on the page of a report.

use std::path::Path;

use glam::DVec3;
use quick_xml::escape::escape;

/// A sign that stays on the line of its number.
pub(super) const PERCENT: &str = "\u{a0}%";

/// A file as the user named it.
pub(super) fn name(file: &Path) -> String {
    match file.as_os_str() == "-" {
        true => "standard input".to_owned(),
        false => {
            format!(r#"<span class="name">{}</span>"#, escape(file.to_string_lossy()))
        }
    }
}

/// The last part of a file's name, without tags.
pub(super) fn last_name(file: &Path) -> String {
    if file.as_os_str() == "-" {
        return "standard input".to_owned();
    }
    let last = file.file_name().unwrap_or(file.as_os_str());
    escape(last.to_string_lossy()).into_owned()
}

/// A fraction in percent, with all its digits but those that the factor has made.
pub(super) fn percent(fraction: f64) -> String {
    let percent = 100.0 * fraction;
    let digits = format!("{percent:.11e}");
    format!("{}{PERCENT}", digits.parse().unwrap_or(percent))
}

/// A point to about a millionth of the size of what it belongs to.
pub(super) fn place(point: DVec3, size: f64) -> String {
    #[expect(clippy::cast_possible_truncation, reason = "between 0 and 12")]
    #[expect(clippy::cast_sign_loss, reason = "between 0 and 12")]
    let decimals = (5.0 - size.log10().floor()).clamp(0.0, 12.0) as usize;
    let coordinate = |x: f64| {
        if !(1e-6..1e9).contains(&size) {
            return if x == 0.0 { "0".to_owned() } else { format!("{x:.6e}") };
        }
        let text = format!("{x:.decimals$}");
        match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
            false => text,
        }
    };
    let [x, y, z] = point.to_array().map(coordinate);
    format!("({x}, {y}, {z})")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_as_exact_as_eyes_need() {
        let point = DVec3::new(1.0 / 3.0, -20.0, 1e-9);
        assert_eq!(place(point, 100.0), "(0.333, -20, 0)");
        assert_eq!(place(point, 2e-6), "(0.33333333333, -20, 0.000000001)");
        assert_eq!(place(point, 0.9e9), "(0, -20, 0)");
        let far = DVec3::new(1e39 / 3.0, 0.0, -2e-40);
        assert_eq!(place(far, 1e39), "(3.333333e38, 0, -2.000000e-40)");
    }

    #[test]
    fn names_are_no_tags() {
        let named = name(Path::new("a/<b>&\"'\r.csg"));
        let expected =
            "<span class=\"name\">a/&lt;b&gt;&amp;&quot;&apos;&#13;.csg</span>";
        assert_eq!(named, expected);
        assert_eq!(last_name(Path::new("a/<b>.csg")), "&lt;b&gt;.csg");
        assert_eq!(last_name(Path::new("..")), "..");
        assert_eq!(name(Path::new("-")), "standard input");
    }

    #[test]
    fn percents_are_those_that_were_meant() {
        assert_eq!(
            [1e-3, 0.07, 1.0, 0.0014985, 1e-7].map(percent),
            ["0.1", "7", "100", "0.14985", "0.00001"].map(|n| format!("{n}\u{a0}%"))
        );
    }
}
