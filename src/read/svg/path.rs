//! The lines of a path (W3C, "Scalable Vector Graphics 1.1", chapter 8.3).

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use super::super::fineness::whole;
use super::super::words::quoted;
use super::Cut;
use super::stroke::Stroke;
use crate::angle::{cos_deg, sin_deg};

/// What a path encloses: its closed lines, those that end where they begin, and what its open
/// ones cover. Where one line is closed, the last one of all need not be.
pub(super) fn lines(
    text: &str,
    stroke: &Stroke,
    cut: &Cut,
) -> Result<Vec<Vec<DVec2>>, String> {
    let mut done: Vec<Vec<DVec2>> = Vec::new();
    let (mut pen, mut is_closed) = (Pen::default(), false);
    let (mut words, mut command) = (Words { rest: text }, None);
    let finish = |pen: &mut Pen, done: &mut Vec<Vec<DVec2>>, is_stroked: bool| {
        let line = std::mem::take(&mut pen.points);
        if is_stroked && is_open(&line) {
            done.extend(stroke.around(&line)?);
        } else {
            done.push(line);
        }
        Ok::<(), String>(())
    };
    loop {
        if let Some(next) = words.command() {
            command = Some(next);
            if next.eq_ignore_ascii_case(&'z') {
                // Goes on from where the line began.
                if let Some(&start) = pen.points.first() {
                    pen.at = start;
                }
                pen.control = Control::None;
                finish(&mut pen, &mut done, false)?;
                is_closed = true;
            }
        }
        if words.is_at_command()? {
            continue;
        }
        let Some(letter) = command else { break };
        if words.rest.is_empty() {
            break;
        }
        let origin = if letter.is_ascii_lowercase() { pen.at } else { DVec2::ZERO };
        match letter.to_ascii_lowercase() {
            'm' => {
                let to = origin + words.point()?;
                finish(&mut pen, &mut done, true)?;
                pen.line(to);
                command = Some(if letter == 'm' { 'l' } else { 'L' });
            }
            'l' => pen.line(origin + words.point()?),
            'h' => pen.line(DVec2::new(origin.x + words.number()?, pen.at.y)),
            'v' => pen.line(DVec2::new(pen.at.x, origin.y + words.number()?)),
            'c' => {
                let [a, b] = [origin + words.point()?, origin + words.point()?];
                pen.cubic(a, b, origin + words.point()?, cut);
            }
            's' => {
                let (a, b) = (pen.mirrored(true), origin + words.point()?);
                pen.cubic(a, b, origin + words.point()?, cut);
            }
            'q' => {
                let a = origin + words.point()?;
                pen.quadratic(a, origin + words.point()?, cut);
            }
            't' => {
                let a = pen.mirrored(false);
                pen.quadratic(a, origin + words.point()?, cut);
            }
            'a' => {
                let (radii, turn) = (words.point()?.abs(), words.number()?);
                let flags = [words.flag()?, words.flag()?];
                pen.arc(radii, turn, flags, origin + words.point()?, cut)?;
            }
            // Numbers after the end of a line.
            _ => return Err(format!("the path {}", quoted(words.rest.as_bytes()))),
        }
    }
    finish(&mut pen, &mut done, !is_closed)?;
    Ok(done)
}

/// Whether a line ends anywhere but where it begins, by OpenSCAD's measure.
fn is_open(line: &[DVec2]) -> bool {
    let ends = line.first().zip(line.last());
    ends.is_some_and(|(a, b)| a.distance(*b) > 0.1)
}

/// The point that a smooth curve goes on from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Control {
    #[default]
    None,
    Cubic(DVec2),
    Quadratic(DVec2),
}

/// What draws a line.
#[derive(Debug, Default)]
pub(super) struct Pen {
    at: DVec2,
    points: Vec<DVec2>,
    control: Control,
}

impl Pen {
    pub(super) fn into_points(self) -> Vec<DVec2> {
        self.points
    }

    /// A straight line, or the start of one.
    pub(super) fn line(&mut self, to: DVec2) {
        self.points.push(to);
        self.at = to;
        self.control = Control::None;
    }

    /// The point that makes a curve go on smoothly.
    fn mirrored(&self, is_cubic: bool) -> DVec2 {
        match self.control {
            Control::Cubic(p) if is_cubic => 2.0 * self.at - p,
            Control::Quadratic(p) if !is_cubic => 2.0 * self.at - p,
            Control::None | Control::Cubic(_) | Control::Quadratic(_) => self.at,
        }
    }

    fn cubic(&mut self, a: DVec2, b: DVec2, to: DVec2, cut: &Cut) {
        let from = self.at;
        let bends = [from - 2.0 * a + b, a - 2.0 * b + to].map(DVec2::length);
        self.curve(cut.curve(6.0 * bends[0].max(bends[1])), |t| {
            let s = 1.0 - t;
            s * s * s * from + 3.0 * t * s * s * a + 3.0 * t * t * s * b + t * t * t * to
        });
        (self.at, self.control) = (to, Control::Cubic(b));
    }

    fn quadratic(&mut self, a: DVec2, to: DVec2, cut: &Cut) {
        let from = self.at;
        let bend = (from - 2.0 * a + to).length();
        self.curve(cut.curve(2.0 * bend), |t| {
            let s = 1.0 - t;
            s * s * from + 2.0 * t * s * a + t * t * to
        });
        (self.at, self.control) = (to, Control::Quadratic(a));
    }

    fn curve(&mut self, pieces: u32, at: impl Fn(f64) -> DVec2) {
        let points = (1..=pieces).map(|i| at(f64::from(i) / f64::from(pieces)));
        self.points.extend(points);
    }

    /// An arc of an ellipse whose first axis is turned by so many degrees, the large one of the
    /// two and the one of growing angles if the flags say so (appendix F.6.5). Radii that are too
    /// small grow.
    pub(super) fn arc(
        &mut self,
        radii: DVec2,
        turn: f64,
        [is_large, is_sweep]: [bool; 2],
        to: DVec2,
        cut: &Cut,
    ) -> Result<(), String> {
        let axis = DVec2::new(cos_deg(turn), sin_deg(turn));
        let half = 0.5 * (self.at - to);
        let half = DVec2::new(axis.dot(half), axis.perp_dot(half));
        let is_arc = radii.min_element() > 0.0 && half.length() > 0.0;
        if !is_arc || !(radii + half).is_finite() {
            return Err("an arc without length or radius".to_owned());
        }
        let reach = (half / radii).length();
        let radii = radii * reach.max(1.0);
        // In units of the radii the ellipse is a circle of radius 1.
        let unit = half / radii;
        let away = (1.0 / unit.length_squared() - 1.0).max(0.0).sqrt();
        let side = if is_large == is_sweep { -1.0 } else { 1.0 };
        let center = side * away * DVec2::new(unit.y, -unit.x);
        let start = (unit - center).to_angle();
        let mut sweep = ((-unit - center).to_angle() - start).rem_euclid(TAU);
        if !is_sweep {
            sweep -= TAU;
        }
        let middle = 0.5 * (self.at + to);
        let pieces = cut.arc(sweep.abs(), radii.max_element());
        let point = |i: u32| {
            let angle = start + sweep * f64::from(i) / f64::from(pieces);
            let local = radii * (center + DVec2::from_angle(angle));
            middle + axis.rotate(local)
        };
        self.points.extend((0..=pieces).map(point));
        (self.at, self.control) = (to, Control::None);
        Ok(())
    }
}

impl Cut {
    /// The most pieces of a curve.
    const MOST: f64 = 1440.0;

    /// How many lines stand for a curve whose second derivative is at most so long: a line is
    /// within an eighth of that, over the square of their number.
    fn curve(&self, bend: f64) -> u32 {
        let Some(tolerance) = self.tolerance else { return 20 };
        whole((bend / (8.0 * tolerance)).sqrt().ceil().min(Self::MOST)).max(1)
    }

    /// How many lines stand for an arc of an angle.
    fn arc(&self, angle: f64, radius: f64) -> u32 {
        let Some(tolerance) = self.tolerance else {
            return whole(angle * 10.0 / PI + 4.0);
        };
        let half = (1.0 - (tolerance / radius).min(1.0)).acos();
        whole((0.5 * angle / half).ceil().min(Self::MOST)).max(4)
    }
}

/// The words of a path.
struct Words<'a> {
    rest: &'a str,
}

impl Words<'_> {
    fn skip(&mut self) {
        self.rest = self.rest.trim_start_matches([' ', ',']);
    }

    /// The command that stands here.
    fn command(&mut self) -> Option<char> {
        self.skip();
        let letter =
            self.rest.chars().next().filter(|c| "zmlcqahvstZMLCQAHVST".contains(*c))?;
        self.rest = &self.rest[1..];
        Some(letter)
    }

    /// Whether a command stands here; else it is a number, or the end.
    fn is_at_command(&mut self) -> Result<bool, String> {
        self.skip();
        let Some(next) = self.rest.chars().next() else { return Ok(false) };
        if next.is_ascii_digit() || matches!(next, '.' | '-') {
            return Ok(false);
        }
        let is_command = "zmlcqahvstZMLCQAHVST".contains(next);
        is_command.then_some(true).ok_or_else(|| self.strange())
    }

    fn point(&mut self) -> Result<DVec2, String> {
        Ok(DVec2::new(self.number()?, self.number()?))
    }

    /// A number: it ends before a second point or a sign. OpenSCAD does not know the sign `+`.
    fn number(&mut self) -> Result<f64, String> {
        self.skip();
        let bytes = self.rest.as_bytes();
        let mut end = usize::from(bytes.first() == Some(&b'-'));
        let (mut has_point, mut has_power) = (false, false);
        while let Some(byte) = bytes.get(end) {
            match byte {
                b'0'..=b'9' => {}
                b'.' if !has_point && !has_power => has_point = true,
                b'e' | b'E' if !has_power => {
                    has_power = true;
                    end += usize::from(matches!(bytes.get(end + 1), Some(b'-' | b'+')));
                }
                b'+' => return Err(self.strange()),
                _ => break,
            }
            end += 1;
        }
        let number = self.rest[..end].parse().ok().filter(|x: &f64| x.is_finite());
        let number = number.ok_or_else(|| self.strange())?;
        self.rest = &self.rest[end..];
        Ok(number)
    }

    /// A flag, which is 0 or 1 and a word of its own: OpenSCAD knows no others.
    fn flag(&mut self) -> Result<bool, String> {
        self.skip();
        let mut chars = self.rest.chars();
        let flag = chars.next().filter(|c| matches!(c, '0' | '1'));
        match (flag, chars.next()) {
            (Some(flag), Some(' ' | ',' | '-')) => {
                self.rest = &self.rest[1..];
                Ok(flag == '1')
            }
            _ => Err(self.strange()),
        }
    }

    fn strange(&self) -> String {
        format!("the path {}", quoted(self.rest.as_bytes()))
    }
}
