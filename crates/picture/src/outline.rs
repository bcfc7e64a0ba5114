//! Flat shapes with names, such as the pieces of a pattern, drawn on one image to one scale.

use crate::PictureError;
use crate::colour::{Rgb, mix};
use crate::image::Image;
use crate::text::{Align, TextStyle, text_width};
use toile_geometry::Vec2;

/// One flat shape with its inner lines.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Written in its middle.
    pub name: String,
    /// Closed rings (m), y up: the outline and its holes, without the first point repeated.
    pub rings: Vec<Vec<Vec2>>,
    /// Open lines inside (m), such as a grainline or notches.
    pub lines: Vec<Vec<Vec2>>,
    /// Colour of the outline; the inside gets a light tint of it.
    pub colour: Rgb,
}

/// Draws shapes on white paper in rows, all to the same scale, with their names and a scale bar.
///
/// # Errors
/// No shape has a ring of three points, a coordinate is not finite, or the size is empty or too
/// large.
pub fn outline_picture(
    outlines: &[Outline],
    title: &str,
    [width, height]: [usize; 2],
) -> Result<Image, PictureError> {
    let mut image = Image::new(width, height, [1.0; 3])?;
    let boxes: Vec<[Vec2; 2]> = outlines.iter().map(bounds).collect::<Result<_, _>>()?;
    if boxes.is_empty() {
        return Err(PictureError::Empty);
    }
    let letters = (0.014 * height as f64).max(7.0);
    let area = [width as f64 - 4.0 * letters, height as f64 - 11.0 * letters];
    let gap = 2.0 * letters;
    let scale = largest_scale(&boxes, area, gap);
    let (places, used) = rows(&boxes, scale, area[0], gap);
    let top = 5.5 * letters + 0.5 * (area[1] - used).max(0.0);
    for ((outline, [low, high]), [x, y]) in outlines.iter().zip(&boxes).zip(places) {
        let at = |p: &Vec2| {
            [
                2.0 * letters + x + scale * (p.x - low.x),
                top + y + scale * (high.y - p.y),
            ]
        };
        draw(&mut image, outline, at, letters);
    }
    image.write(
        [2.5 * letters, 3.4 * letters],
        title,
        &TextStyle::plain(1.35 * letters),
    );
    draw_scale(&mut image, scale, letters);
    Ok(image)
}

fn bounds(outline: &Outline) -> Result<[Vec2; 2], PictureError> {
    let points = || outline.rings.iter().chain(&outline.lines).flatten();
    if !points().all(|p| p.x.abs() < 1e9 && p.y.abs() < 1e9) {
        return Err(PictureError::NotFinite("a point of an outline"));
    }
    if outline.rings.iter().all(|ring| ring.len() < 3) {
        return Err(PictureError::Empty);
    }
    let first = points().next().copied().unwrap_or_default();
    Ok(points().fold([first, first], |[low, high], p| [low.inf(p), high.sup(p)]))
}

/// Upper left corners of the boxes set in rows (pixel), and the height they take.
fn rows(boxes: &[[Vec2; 2]], scale: f64, width: f64, gap: f64) -> (Vec<[f64; 2]>, f64) {
    let mut places: Vec<[f64; 2]> = Vec::new();
    let (mut x, mut y, mut row_height, mut row_start) = (0.0, 0.0, 0.0_f64, 0);
    let centre = |places: &mut [[f64; 2]], used: f64| {
        places
            .iter_mut()
            .for_each(|p| p[0] += 0.5 * (width - used).max(0.0));
    };
    for (k, [low, high]) in boxes.iter().enumerate() {
        let size = (high - low) * scale;
        if k > row_start && x + size.x > width {
            centre(&mut places[row_start..], x - gap);
            (x, y, row_height, row_start) = (0.0, y + row_height + gap, 0.0, k);
        }
        places.push([x, y]);
        x += size.x + gap;
        row_height = row_height.max(size.y);
    }
    centre(&mut places[row_start..], x - gap);
    (places, y + row_height)
}

/// The largest scale (pixel/m) at which all boxes fit, by bisection.
fn largest_scale(boxes: &[[Vec2; 2]], [width, height]: [f64; 2], gap: f64) -> f64 {
    let widest = boxes
        .iter()
        .map(|b| (b[1] - b[0]).max())
        .fold(1e-9, f64::max);
    let fits = |scale: f64| {
        boxes.iter().all(|b| (b[1].x - b[0].x) * scale <= width)
            && rows(boxes, scale, width, gap).1 <= height
    };
    let (mut low, mut high) = (0.0, width.max(height) / widest);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if fits(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low.max(1e-9)
}

fn draw(image: &mut Image, outline: &Outline, at: impl Fn(&Vec2) -> [f64; 2], letters: f64) {
    let rings: Vec<Vec<[f64; 2]>> = outline
        .rings
        .iter()
        .map(|ring| ring.iter().map(&at).collect())
        .collect();
    image.fill_rings(&rings, mix([1.0; 3], outline.colour, 0.22));
    let stroke = (0.13 * letters).max(1.2);
    for line in &outline.lines {
        let points: Vec<[f64; 2]> = line.iter().map(&at).collect();
        image.draw_path(&points, 0.7 * stroke, mix([1.0; 3], outline.colour, 0.75));
    }
    let dark = mix(outline.colour, [0.0; 3], 0.35);
    for ring in &rings {
        let closed: Vec<[f64; 2]> = ring.iter().chain(ring.first()).copied().collect();
        image.draw_path(&closed, stroke, dark);
    }
    let style = TextStyle {
        align: Align::Middle,
        ..TextStyle::plain(letters)
    };
    let lines: Vec<Vec<[f64; 2]>> = outline
        .lines
        .iter()
        .map(|line| line.iter().map(&at).collect())
        .collect();
    let wide = text_width(&outline.name, letters) / letters;
    let [x, y] = free_place(&rings, &lines, wide.max(1.0));
    image.write([x, y + 0.5 * letters], &outline.name, &style);
}

/// The place inside rings that is farthest from their edges and from lines, by a search over a
/// grid, for words `wide` times as wide as high: distances across count that much less.
fn free_place(rings: &[Vec<[f64; 2]>], lines: &[Vec<[f64; 2]>], wide: f64) -> [f64; 2] {
    const CELLS: usize = 28;
    let points = || rings.iter().flatten();
    let low = [0, 1].map(|k| points().map(|p| p[k]).fold(f64::INFINITY, f64::min));
    let high = [0, 1].map(|k| points().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max));
    let middle = [0, 1].map(|k| 0.5 * (low[k] + high[k]));
    let closed = || {
        rings
            .iter()
            .flat_map(|r| r.iter().zip(r.iter().cycle().skip(1)))
    };
    let open = || lines.iter().flat_map(|l| l.iter().zip(l.iter().skip(1)));
    let clear = |x: f64, y: f64| {
        let flat = |p: &[f64; 2]| [(p[0] - x) / wide, p[1] - y];
        closed()
            .chain(open())
            .map(|(a, b)| distance_to(flat(a), flat(b)))
            .fold(f64::INFINITY, f64::min)
    };
    let (mut best, mut widest) = (middle, f64::NEG_INFINITY);
    for j in 0..CELLS {
        let y = low[1] + (high[1] - low[1]) * (j as f64 + 0.5) / CELLS as f64;
        let crossed = crossings(rings, y);
        for i in 0..CELLS {
            let x = low[0] + (high[0] - low[0]) * (i as f64 + 0.5) / CELLS as f64;
            if crossed.partition_point(|&c| c < x).is_multiple_of(2) {
                continue;
            }
            // Of places equally free, the one nearest the middle.
            let score = clear(x, y) - 0.02 * (x - middle[0]).hypot(y - middle[1]);
            if score > widest {
                (widest, best) = (score, [x, y]);
            }
        }
    }
    best
}

/// Distance of a segment from the origin.
fn distance_to(a: [f64; 2], b: [f64; 2]) -> f64 {
    let d = [b[0] - a[0], b[1] - a[1]];
    let squared = d[0] * d[0] + d[1] * d[1];
    let t = if squared > 0.0 {
        (-(a[0] * d[0] + a[1] * d[1]) / squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (a[0] + t * d[0]).hypot(a[1] + t * d[1])
}

/// A bar of a round length at the lower left.
fn draw_scale(image: &mut Image, scale: f64, letters: f64) {
    const LENGTHS: [(f64, &str); 7] = [
        (0.01, "1 cm"),
        (0.05, "5 cm"),
        (0.1, "10 cm"),
        (0.2, "20 cm"),
        (0.5, "50 cm"),
        (1.0, "1 m"),
        (5.0, "5 m"),
    ];
    let longest = 0.25 * image.width as f64;
    let chosen = LENGTHS
        .iter()
        .rev()
        .find(|(length, _)| length * scale <= longest);
    let Some((length, words)) = chosen else {
        return;
    };
    let style = TextStyle::plain(letters);
    let y = image.height as f64 - 2.5 * letters;
    let x = 2.5 * letters;
    let end = x + length * scale;
    let tick = 0.5 * letters;
    let bar = [[x, y - tick], [x, y], [end, y], [end, y - tick]];
    image.draw_path(&bar, (0.13 * letters).max(1.2), style.colour);
    if end + letters + text_width(words, letters) < image.width as f64 {
        image.write([end + letters, y], words, &style);
    }
}

impl Image {
    /// Fills rings given in pixels by the even-odd rule, with soft edges: exact coverage along
    /// rows, four lines a row.
    pub fn fill_rings(&mut self, rings: &[Vec<[f64; 2]>], colour: Rgb) {
        const LINES: usize = 4;
        let points = || rings.iter().flatten();
        if !points().flatten().all(|c| c.abs() < 1e7) {
            return;
        }
        let low = points()
            .map(|p| p[1])
            .fold(f64::INFINITY, f64::min)
            .max(0.0);
        let high = points().map(|p| p[1]).fold(f64::NEG_INFINITY, f64::max);
        let last = (high.ceil().max(0.0) as usize).min(self.height);
        for row in (low as usize).min(last)..last {
            let mut cover = vec![0.0; self.width];
            for line in 0..LINES {
                let y = row as f64 + (line as f64 + 0.5) / LINES as f64;
                for pair in crossings(rings, y).chunks_exact(2) {
                    add_span(&mut cover, pair[0], pair[1], 1.0 / LINES as f64);
                }
            }
            for (x, &part) in cover.iter().enumerate().filter(|(_, part)| **part > 0.0) {
                self.blend(x as i64, row as i64, colour, part);
            }
        }
    }
}

/// Where a horizontal line crosses the rings, from left to right.
fn crossings(rings: &[Vec<[f64; 2]>], y: f64) -> Vec<f64> {
    let mut places = Vec::new();
    for ring in rings {
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            if (a[1] <= y) != (b[1] <= y) {
                places.push(a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]));
            }
        }
    }
    places.sort_by(f64::total_cmp);
    places
}

/// Adds the part of each cell that lies between two places, times a weight.
fn add_span(cover: &mut [f64], from: f64, to: f64, weight: f64) {
    let first = from.floor().max(0.0) as usize;
    let last = (to.ceil().max(0.0) as usize).min(cover.len());
    for (x, cell) in cover.iter_mut().enumerate().take(last).skip(first) {
        let part = (to.min(x as f64 + 1.0) - from.max(x as f64)).clamp(0.0, 1.0);
        *cell += weight * part;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area_of(ring: &[[f64; 2]]) -> f64 {
        let next = ring.iter().cycle().skip(1);
        let twice: f64 = ring
            .iter()
            .zip(next)
            .map(|(a, b)| a[0] * b[1] - b[0] * a[1])
            .sum();
        0.5 * twice.abs()
    }

    fn ring(corners: &[(f64, f64)]) -> Vec<Vec2> {
        corners.iter().map(|&(x, y)| Vec2::new(x, y)).collect()
    }

    fn square(name: &str, side: f64) -> Outline {
        Outline {
            name: name.into(),
            rings: vec![ring(&[(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)])],
            lines: vec![],
            colour: [0.0, 0.2, 0.8],
        }
    }

    #[test]
    fn filled_rings_cover_their_area_and_leave_holes() {
        let mut image = Image::new(100, 100, [0.0; 3]).unwrap();
        let outer = vec![[10.3, 10.0], [80.7, 20.0], [60.0, 90.5]];
        let hole = vec![[40.0, 30.0], [60.0, 30.0], [60.0, 45.0], [40.0, 45.0]];
        let wanted = area_of(&outer) - area_of(&hole);
        image.fill_rings(&[outer, hole], [1.0; 3]);
        let sum: f64 = image
            .pixels
            .chunks(4)
            .map(|p| f64::from(p[0]) / 255.0)
            .sum();
        assert!((sum / wanted - 1.0).abs() < 0.003, "{sum} {wanted}");
        assert_eq!(image.pixel(50, 38).unwrap()[0], 0);
    }

    #[test]
    fn pieces_do_not_overlap_and_share_a_scale() {
        let shapes = [
            square("a", 0.5),
            square("b", 0.25),
            square("c", 0.25),
            square("d", 0.5),
        ];
        let boxes: Vec<_> = shapes.iter().map(|s| bounds(s).unwrap()).collect();
        let area = [300.0, 200.0];
        let scale = largest_scale(&boxes, area, 5.0);
        let (places, used) = rows(&boxes, scale, area[0], 5.0);
        assert!(used <= 200.0 && used > 100.0, "{used}");
        for i in 0..4 {
            for j in 0..i {
                let size = |k: usize| scale * (boxes[k][1] - boxes[k][0]).x;
                let apart = (0..2).any(|c| {
                    places[i][c] + size(i) <= places[j][c] || places[j][c] + size(j) <= places[i][c]
                });
                assert!(apart, "{i} {j} {places:?}");
            }
        }
        let image = outline_picture(&shapes, "Pieces", [400, 300]).unwrap();
        let tinted = image
            .pixels
            .chunks(4)
            .filter(|p| p[2] > p[0].saturating_add(20))
            .count();
        assert!(tinted > 5000, "{tinted}");
    }

    #[test]
    fn a_name_stands_inside_and_clear_of_lines() {
        let bent = vec![
            [0.0, 0.0],
            [90.0, 0.0],
            [90.0, 30.0],
            [30.0, 30.0],
            [30.0, 90.0],
            [0.0, 90.0],
        ];
        let [x, y] = free_place(std::slice::from_ref(&bent), &[], 1.0);
        assert!(x < 30.0 || y < 30.0, "{x} {y}");
        let line = vec![[15.0, 0.0], [15.0, 90.0]];
        let [x, y] = free_place(&[bent], &[line], 1.0);
        assert!(y < 30.0 && (x - 15.0).abs() > 10.0, "{x} {y}");
        let flat = vec![[1.0, 1.0], [3.0, 1.0], [2.0, 1.0]];
        assert_eq!(free_place(&[flat], &[], 1.0), [2.0, 1.0]);
    }

    #[test]
    fn shapes_that_are_none_are_refused() {
        let size = [100, 100];
        assert!(matches!(
            outline_picture(&[], "", size),
            Err(PictureError::Empty)
        ));
        let mut shape = square("a", 1.0);
        shape.rings[0].truncate(2);
        assert!(outline_picture(&[shape.clone()], "", size).is_err());
        shape = square("a", f64::NAN);
        assert!(matches!(
            outline_picture(&[shape], "", size),
            Err(PictureError::NotFinite(_))
        ));
        let tiny = [square("a", 1e-12), square("b", 1e6)];
        assert!(outline_picture(&tiny, "", size).is_ok());
    }
}
