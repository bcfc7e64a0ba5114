//! Flat charts: points and lines over two axes, linear or logarithmic, with a legend.

use crate::drawing::{Drawing, Mark};
use crate::text::{Align, text_width};
use crate::{PictureError, Rgb};

/// One axis of a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity shown, with its unit in brackets.
    pub label: String,
    /// Whether equal ratios are equal distances.
    pub logarithmic: bool,
    /// Lowest and highest value shown; none fits the range to the points.
    pub range: Option<[f64; 2]>,
}

impl Axis {
    /// A logarithmic axis that shows all points.
    pub fn logarithmic(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            logarithmic: true,
            range: None,
        }
    }

    /// A linear axis that shows all points.
    pub fn linear(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            logarithmic: false,
            range: None,
        }
    }
}

/// How the points of a series are marked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// Not at all.
    None,
    /// A filled circle.
    Dot,
    /// A filled square.
    Square,
    /// A triangle.
    Triangle,
    /// A lozenge.
    Lozenge,
    /// A ring.
    Ring,
    /// A cross: for what failed.
    Cross,
}

/// How a series is joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Joined {
    /// Points alone.
    Not,
    /// By a thin line.
    Thin,
    /// By a thick pale line behind everything.
    Band,
    /// By a dashed line.
    Dashed,
}

/// Points of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name in the legend; empty for none.
    pub name: String,
    /// Colour of marks and lines.
    pub colour: Rgb,
    /// Shape of the marks.
    pub marker: Marker,
    /// Size of the marks (pixel).
    pub size: f64,
    /// How points are joined.
    pub joined: Joined,
    /// The points, x and y in the units of the axes.
    pub points: Vec<[f64; 2]>,
}

impl Series {
    /// Marks joined by a thin line, in the n-th of a row of colours and shapes that can be told
    /// apart.
    pub fn numbered(number: usize, name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        let markers = [
            Marker::Dot,
            Marker::Square,
            Marker::Triangle,
            Marker::Lozenge,
            Marker::Ring,
        ];
        Self {
            name: name.into(),
            colour: palette(number),
            marker: markers[number % markers.len()],
            size: 8.0,
            joined: Joined::Thin,
            points,
        }
    }
}

/// A colour of a row of eight that keep apart for people who see no difference between red and
/// green (after Okabe and Ito 2008), darker from the ninth on.
pub fn palette(number: usize) -> Rgb {
    const COLOURS: [[u8; 3]; 8] = [
        [0, 114, 178],
        [213, 94, 0],
        [0, 158, 115],
        [204, 121, 167],
        [230, 159, 0],
        [86, 180, 233],
        [90, 60, 140],
        [60, 60, 60],
    ];
    let shade = if (number / COLOURS.len()).is_multiple_of(2) {
        1.0
    } else {
        0.6
    };
    COLOURS[number % COLOURS.len()].map(|c| f64::from(c) / 255.0 * shade)
}

/// A chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Words at the top.
    pub title: String,
    /// The axis across.
    pub x: Axis,
    /// The axis up.
    pub y: Axis,
    /// The series, drawn in order.
    pub series: Vec<Series>,
    /// Lines of small words below.
    pub notes: Vec<String>,
    /// Width and height (pixel).
    pub size: [f64; 2],
}

const INK: Rgb = [0.17, 0.17, 0.19];
const SOFT: Rgb = [0.42, 0.41, 0.40];
const GRID: Rgb = [0.90, 0.90, 0.89];
/// Height of capitals of labels, and of small words (pixel).
const LETTERS: f64 = 9.0;
const SMALL: f64 = 7.5;

/// A value axis laid onto pixels.
struct Laid {
    from: f64,
    to: f64,
    pixels: [f64; 2],
    logarithmic: bool,
}

impl Laid {
    /// Nothing for values the axis cannot show.
    fn place(&self, value: f64) -> Option<f64> {
        let at = if self.logarithmic {
            value.log10()
        } else {
            value
        };
        let part = (at - self.from) / (self.to - self.from);
        (part.is_finite() && (-1e-6..=1.0 + 1e-6).contains(&part))
            .then(|| self.pixels[0] + part * (self.pixels[1] - self.pixels[0]))
    }

    fn new(axis: &Axis, values: impl Iterator<Item = f64>, pixels: [f64; 2]) -> Option<Self> {
        let lay = |v: f64| if axis.logarithmic { v.log10() } else { v };
        let (mut from, mut to) = match axis.range {
            Some([low, high]) => (lay(low), lay(high)),
            None => values
                .map(lay)
                .filter(|v| v.is_finite())
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
                    (low.min(v), high.max(v))
                }),
        };
        if !(from.is_finite() && to.is_finite()) {
            return None;
        }
        if axis.range.is_none() {
            let room = (0.06 * (to - from)).max(if axis.logarithmic { 0.15 } else { 1e-9 });
            (from, to) = (from - room, to + room);
        }
        (to > from).then_some(Self {
            from,
            to,
            pixels,
            logarithmic: axis.logarithmic,
        })
    }

    /// Values at which the axis is labelled.
    fn ticks(&self) -> Vec<f64> {
        if self.logarithmic {
            let span = self.to - self.from;
            let factors: &[f64] = if span < 2.2 { &[1.0, 2.0, 5.0] } else { &[1.0] };
            let stride = (span / 8.0).ceil().max(1.0) as i32;
            let decades = self.from.floor() as i32..=self.to.ceil() as i32;
            return decades
                .filter(|d| d.rem_euclid(stride) == 0)
                .flat_map(|d| factors.iter().map(move |f| f * 10f64.powi(d)))
                .filter(|v| (self.from - 1e-9..=self.to + 1e-9).contains(&v.log10()))
                .collect();
        }
        let rough = (self.to - self.from) / 6.0;
        let power = 10f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0]
            .map(|f| f * power)
            .into_iter()
            .find(|s| *s >= rough)
            .unwrap_or(power);
        let first = (self.from / step).ceil() as i64;
        let last = (self.to / step).floor() as i64;
        (first..=last).map(|k| k as f64 * step).collect()
    }
}

/// A number for an axis.
fn tick_label(value: f64) -> String {
    let magnitude = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e4).contains(&magnitude) {
        let text = format!("{value:.4}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        let text = format!("{value:.1e}");
        text.replace(".0e", "e")
    }
}

impl Chart {
    /// Lays the chart out.
    ///
    /// # Errors
    /// There is not a single point its axes can show.
    pub fn draw(&self) -> Result<Drawing, PictureError> {
        let [width, height] = self.size;
        let named: Vec<&Series> = self.series.iter().filter(|s| !s.name.is_empty()).collect();
        let widest = named
            .iter()
            .map(|s| text_width(&s.name, SMALL))
            .fold(0.0, f64::max);
        let legend = if named.is_empty() {
            16.0
        } else {
            1.15 * widest + 52.0
        };
        let bottom = height - 52.0 - 14.0 * self.notes.len() as f64;
        let across = [76.0, width - legend];
        let up = [bottom, 40.0];
        let points = || self.series.iter().flat_map(|s| &s.points);
        let x = Laid::new(&self.x, points().map(|p| p[0]), across).ok_or(PictureError::Empty)?;
        let y = Laid::new(&self.y, points().map(|p| p[1]), up).ok_or(PictureError::Empty)?;
        let mut marks = Vec::new();
        self.frame(&mut marks, &x, &y);
        let bands = |s: &&Series| s.joined == Joined::Band;
        for series in self.series.iter().filter(bands) {
            draw_series(&mut marks, series, &x, &y);
        }
        for series in self.series.iter().filter(|s| !bands(s)) {
            draw_series(&mut marks, series, &x, &y);
        }
        for (k, series) in named.iter().enumerate() {
            let at = [width - legend + 18.0, 52.0 + 17.0 * k as f64];
            draw_line(
                &mut marks,
                series,
                vec![[at[0] - 9.0, at[1]], [at[0] + 9.0, at[1]]],
            );
            draw_marker(&mut marks, series, at);
            words(
                &mut marks,
                [at[0] + 16.0, at[1] + 0.5 * SMALL],
                &series.name,
                SMALL,
                Align::Left,
            );
        }
        for (k, note) in self.notes.iter().enumerate() {
            let at = [
                across[0],
                height - 8.0 - 14.0 * (self.notes.len() - 1 - k) as f64,
            ];
            words(&mut marks, at, note, SMALL, Align::Left);
        }
        Ok(Drawing {
            size: self.size,
            marks,
        })
    }

    fn frame(&self, marks: &mut Vec<Mark>, x: &Laid, y: &Laid) {
        let ([left, right], [bottom, top]) = (x.pixels, y.pixels);
        let mut line = |points: Vec<[f64; 2]>, colour: Rgb, width: f64| {
            marks.push(Mark::Path {
                points,
                width,
                colour,
                dashed: false,
            });
        };
        let place = |laid: &Laid| -> Vec<(f64, f64)> {
            let ticks = laid.ticks().into_iter();
            ticks
                .filter_map(|v| laid.place(v).map(|p| (v, p)))
                .collect()
        };
        let (columns, rows) = (place(x), place(y));
        for &(_, p) in &columns {
            line(vec![[p, bottom], [p, top]], GRID, 1.0);
        }
        for &(_, p) in &rows {
            line(vec![[left, p], [right, p]], GRID, 1.0);
        }
        line(vec![[left, top], [left, bottom], [right, bottom]], INK, 1.2);
        for (v, p) in columns {
            words(
                marks,
                [p, bottom + 16.0],
                &tick_label(v),
                SMALL,
                Align::Middle,
            );
        }
        for (v, p) in rows {
            words(
                marks,
                [left - 7.0, p + 0.5 * SMALL],
                &tick_label(v),
                SMALL,
                Align::Right,
            );
        }
        words(
            marks,
            [left, 22.0],
            &self.title,
            1.15 * LETTERS,
            Align::Left,
        );
        words(
            marks,
            [0.5 * (left + right), bottom + 37.0],
            &self.x.label,
            LETTERS,
            Align::Middle,
        );
        marks.push(Mark::Words {
            at: [18.0, 0.5 * (bottom + top)],
            text: self.y.label.clone(),
            height: LETTERS,
            align: Align::Middle,
            upright: true,
            colour: INK,
        });
    }
}

fn words(marks: &mut Vec<Mark>, at: [f64; 2], text: &str, height: f64, align: Align) {
    marks.push(Mark::Words {
        at,
        text: text.to_owned(),
        height,
        align,
        upright: false,
        colour: if height < LETTERS { SOFT } else { INK },
    });
}

fn draw_series(marks: &mut Vec<Mark>, series: &Series, x: &Laid, y: &Laid) {
    let placed: Vec<[f64; 2]> = series
        .points
        .iter()
        .filter_map(|p| Some([x.place(p[0])?, y.place(p[1])?]))
        .collect();
    draw_line(marks, series, placed.clone());
    for at in placed {
        draw_marker(marks, series, at);
    }
}

fn draw_line(marks: &mut Vec<Mark>, series: &Series, points: Vec<[f64; 2]>) {
    if points.len() < 2 || series.joined == Joined::Not {
        return;
    }
    marks.push(Mark::Path {
        points,
        width: if series.joined == Joined::Band {
            9.0
        } else {
            1.4
        },
        colour: series.colour,
        dashed: series.joined == Joined::Dashed,
    });
}

fn draw_marker(marks: &mut Vec<Mark>, series: &Series, [x, y]: [f64; 2]) {
    let r = 0.5 * series.size;
    let mut path = |points: Vec<[f64; 2]>, width: f64| {
        marks.push(Mark::Path {
            points,
            width,
            colour: series.colour,
            dashed: false,
        });
    };
    match series.marker {
        Marker::None => {}
        Marker::Dot => path(vec![[x, y]], series.size),
        Marker::Square => marks.push(Mark::Box {
            from: [x - r, y - r],
            to: [x + r, y + r],
            colour: series.colour,
        }),
        Marker::Triangle => path(
            vec![[x - r, y + r], [x + r, y + r], [x, y - r], [x - r, y + r]],
            1.8,
        ),
        Marker::Lozenge => path(
            vec![[x - r, y], [x, y + r], [x + r, y], [x, y - r], [x - r, y]],
            1.8,
        ),
        Marker::Ring => {
            let turn = |k: i32| std::f64::consts::TAU * f64::from(k) / 16.0;
            path(
                (0..=16)
                    .map(|k| [x + r * turn(k).cos(), y + r * turn(k).sin()])
                    .collect(),
                1.8,
            );
        }
        Marker::Cross => {
            path(vec![[x - r, y - r], [x + r, y + r]], 1.8);
            path(vec![[x - r, y + r], [x + r, y - r]], 1.8);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart() -> Chart {
        Chart {
            title: "cost".to_owned(),
            x: Axis::logarithmic("time [ms]"),
            y: Axis::logarithmic("error [m]"),
            series: vec![
                Series::numbered(0, "one", vec![[1.0, 1e-2], [10.0, 1e-3], [100.0, 1e-4]]),
                Series::numbered(1, "two", vec![[2.0, 1e-2], [0.0, 1e-3]]),
            ],
            notes: vec!["a note".to_owned()],
            size: [640.0, 420.0],
        }
    }

    #[test]
    fn points_lie_where_their_logarithms_say() {
        let drawing = chart().draw().unwrap();
        let line = drawing.marks.iter().find_map(|m| match m {
            Mark::Path { points, width, .. } if points.len() == 3 && *width == 1.4 => Some(points),
            _ => None,
        });
        let p = line.unwrap();
        // Equal ratios, equal distances.
        assert!(((p[1][0] - p[0][0]) - (p[2][0] - p[1][0])).abs() < 1e-9);
        assert!(p[2][1] > p[0][1], "smaller errors lie lower");
        // What a logarithmic axis cannot show is left out, and the rest is drawn.
        assert!(drawing.to_image().is_ok());
        let svg = drawing.to_svg();
        assert!(svg.contains("error [m]") && svg.contains("two") && svg.contains("a note"));
    }

    #[test]
    fn ticks_are_round_numbers_inside_the_axis() {
        let axis = Axis {
            label: String::new(),
            logarithmic: false,
            range: Some([-0.3, 4.7]),
        };
        let laid = Laid::new(&axis, std::iter::empty(), [0.0, 100.0]).unwrap();
        assert_eq!(laid.ticks(), [0.0, 1.0, 2.0, 3.0, 4.0]);
        assert_eq!(tick_label(0.25), "0.25");
        assert_eq!(tick_label(1e-5), "1e-5");
    }

    #[test]
    fn a_chart_without_points_is_refused() {
        let mut empty = chart();
        empty.series.clear();
        assert!(empty.draw().is_err());
        empty.series = vec![Series::numbered(0, "none", vec![[-1.0, f64::NAN]])];
        assert!(empty.draw().is_err());
    }
}
