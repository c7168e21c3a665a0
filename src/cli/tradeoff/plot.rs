//! What was measured, as a plot.

use std::io::Cursor;
use std::ops::Range;

use anyhow::{Context, anyhow};
use image::{ImageFormat, RgbImage};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};

use super::pictures::WIDTH;
use super::table::seconds;
use super::{Report, Series, Trial};

/// Pixels of the plot; it is meant to be shown at half its size.
const SIZE: [u32; 2] = [1600, 2000];
/// It is drawn so many times as large, for smooth edges.
const FINER: u32 = 2;
const FONT: &str = "sans-serif";
const GREY: RGBColor = RGBColor(150, 150, 150);
const LIGHT: RGBColor = RGBColor(225, 225, 225);
const DARK: RGBColor = RGBColor(60, 60, 60);

/// Colours that people with any colour vision tell apart (M. Okabe, K. Ito, "Color Universal
/// Design", 2008); facets are always the last.
const COLORS: [RGBColor; 5] = [
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];
const FACETS: RGBColor = RGBColor(213, 94, 0);

type Area<'a> = DrawingArea<BitMapBackend<'a>, Shift>;

/// The plot as a .png.
pub(super) fn png(report: &Report) -> anyhow::Result<Vec<u8>> {
    register_font(FONT, FontStyle::Normal, dejavu::sans::regular())
        .map_err(|_| anyhow!("the font of the plot cannot be read"))?;
    let [width, height] = SIZE.map(|size| size * FINER);
    let mut image = RgbImage::new(width, height);
    {
        let backend = BitMapBackend::with_buffer(&mut image, (width, height));
        let root = backend.into_drawing_area();
        draw(report, &root).map_err(|error| anyhow!("the plot: {error}"))?;
        root.present().map_err(|error| anyhow!("the plot: {error}"))?;
    }
    let image = image::imageops::thumbnail(&image, SIZE[0], SIZE[1]);
    let mut png = Cursor::new(Vec::new());
    image.write_to(&mut png, ImageFormat::Png).context("the plot")?;
    Ok(png.into_inner())
}

fn px(size: u32) -> u32 {
    size * FINER
}

type Drawn = Result<(), Box<dyn std::error::Error>>;

fn draw(report: &Report, root: &Area<'_>) -> Drawn {
    root.fill(&WHITE)?;
    let reference = &report.volumes.reference;
    let upper = Panel {
        title: format!("{}: what a volume costs", name_of(&report.file)),
        up: "relative error",
        series: &report.volumes.series,
        floor: Some((
            reference.half_width / reference.value,
            format!("half width of the reference ({})", reference.method),
        )),
        show_power: true,
    };
    let Some(pictures) = &report.pictures else { return upper.draw(root) };
    let (top, bottom) = root.split_vertically(px(SIZE[1] / 2));
    upper.draw(&top)?;
    let up = format!("outline off by, pixels of {WIDTH} across");
    let lower = Panel {
        title: "What a picture costs, 1 to 64 samples a pixel".to_owned(),
        up: &up,
        series: &pictures.series,
        floor: None,
        show_power: false,
    };
    lower.draw(&bottom)
}

fn name_of(file: &str) -> String {
    let path = std::path::Path::new(file);
    path.file_stem().map_or(file.to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// Errors against seconds, both in decades.
struct Panel<'a> {
    title: String,
    up: &'a str,
    series: &'a [Series],
    /// An error below which nothing can be told, and why.
    floor: Option<(f64, String)>,
    show_power: bool,
}

impl Panel<'_> {
    fn draw(&self, area: &Area<'_>) -> Drawn {
        let trials = || self.series.iter().flat_map(|series| &series.trials);
        let least = self.floor.as_ref().map_or(0.0, |floor| floor.0).max(1e-16);
        let seconds_of = |trial: &Trial| trial.seconds.max(1e-6);
        let across = decades(trials().map(seconds_of));
        let up = decades(trials().map(|trial| trial.error.max(least)));
        let mut chart = ChartBuilder::on(area)
            .margin(px(24))
            .margin_left(px(10))
            .margin_right(px(60))
            .caption(&self.title, (FONT, px(40)).into_font().color(&BLACK))
            .x_label_area_size(px(90))
            .y_label_area_size(px(150))
            .build_cartesian_2d(across.log_scale(), up.log_scale())?;
        chart
            .configure_mesh()
            .x_desc("seconds of one thread")
            .y_desc(self.up)
            .axis_desc_style((FONT, px(30)).into_font().color(&DARK))
            .label_style((FONT, px(28)).into_font().color(&DARK))
            .bold_line_style(LIGHT.stroke_width(FINER))
            .light_line_style(TRANSPARENT)
            .axis_style(GREY.stroke_width(FINER))
            .x_label_formatter(&|x| seconds(*x).replace(".0 ", " "))
            .y_label_formatter(&|y| power(*y))
            .draw()?;
        if let Some((floor, why)) = self.floor.as_ref().filter(|floor| floor.0 > 1e-16) {
            let ends = chart.x_range();
            let line = [(ends.start, *floor), (ends.end, *floor)];
            let style = GREY.stroke_width(2 * FINER);
            chart
                .draw_series(DashedLineSeries::new(line, px(14), px(10), style))?
                .label(why.as_str())
                .legend(move |(x, y)| {
                    PathElement::new([(x, y), (x + legend_width(), y)], style)
                });
        }
        let mut colors = COLORS.iter().cycle();
        for series in self.series {
            let is_facets = series.unit == "triangles";
            let color = if is_facets { FACETS } else { *colors.next().unwrap_or(&BLACK) };
            let at = |trial: &Trial| (seconds_of(trial), trial.error.max(least));
            let points: Vec<(f64, f64)> = series.trials.iter().map(at).collect();
            let promised: Vec<(f64, f64)> = series
                .trials
                .iter()
                .filter_map(|t| Some((seconds_of(t), t.half_width?.max(least))))
                .collect();
            let promise = color.mix(0.45).stroke_width(2 * FINER);
            chart.draw_series(DashedLineSeries::new(promised, px(6), px(8), promise))?;
            let full = color.stroke_width(4 * FINER);
            let label = self.label(series);
            chart
                .draw_series(LineSeries::new(points.iter().copied(), full))?
                .label(label)
                .legend(move |(x, y)| {
                    PathElement::new([(x, y), (x + legend_width(), y)], full)
                });
            let dot = |&at: &(f64, f64)| Circle::new(at, px(8), color.filled());
            chart.draw_series(points.iter().map(dot))?;
            if is_facets {
                let style = (FONT, px(24)).into_font().color(&FACETS);
                let texts = series.trials.iter().map(|trial| {
                    let text = trial.setting.replace("$fn = ", "");
                    let offset = (px(12).cast_signed(), -px(30).cast_signed());
                    EmptyElement::at(at(trial)) + Text::new(text, offset, style.clone())
                });
                chart.draw_series(texts)?;
            }
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerLeft)
            .margin(px(20))
            .legend_area_size(px(70))
            .background_style(WHITE.mix(0.85))
            .border_style(LIGHT)
            .label_font((FONT, px(27)).into_font().color(&DARK))
            .draw()?;
        Ok(())
    }

    fn label(&self, series: &Series) -> String {
        match series.order.filter(|_| self.show_power) {
            Some(order) => format!("{}, error ~ {}^{order:.2}", series.name, series.unit),
            None => series.name.clone(),
        }
    }
}

fn legend_width() -> i32 {
    px(54).cast_signed()
}

/// A range of whole decades around some numbers.
fn decades(numbers: impl Iterator<Item = f64>) -> Range<f64> {
    let [mut low, mut high] = [f64::INFINITY, 0.0_f64];
    for number in numbers {
        (low, high) = (low.min(number), high.max(number));
    }
    // As the numbers themselves are written: powers would be rounded, and miss their places.
    let whole = |x: f64| format!("1e{x:.0}").parse().unwrap_or(1.0);
    let (low, high): (f64, f64) =
        (whole(low.log10().floor()), whole(high.log10().ceil()));
    low..high.max(10.0 * low)
}

/// A power of ten, short. Axes come with powers that are rounded.
fn power(x: f64) -> String {
    #[expect(clippy::cast_possible_truncation, reason = "exponents are small")]
    let exponent = x.log10().round() as i32;
    match exponent {
        0.. => format!("{}", 10.0_f64.powi(exponent)),
        -3..0 => {
            let digits = usize::try_from(-exponent).unwrap_or(0);
            format!("{x:.digits$}")
        }
        _ => format!("1e{exponent}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_short() {
        let shown = [1e3, 1.0, 0.09999999999999998, 1e-3, 1.0000000000000002e-7];
        assert_eq!(shown.map(power), ["1000", "1", "0.1", "0.001", "1e-7"]);
    }

    #[test]
    fn ranges_are_whole_decades() {
        assert_eq!(decades([0.02, 3.0].into_iter()), 0.01..10.0);
        assert_eq!(decades([1.0].into_iter()), 1.0..10.0);
    }
}
