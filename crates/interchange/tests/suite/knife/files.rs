//! Strokes read from files: those that a knife follows, seam lines, cut lines. Nothing here knows
//! how the files are written.

use std::collections::BTreeMap;
use toile_geometry::Vec2;

pub type Line = Vec<Vec2>;

/// Strokes of a file (m). Those of the knife that are closed end where they start.
#[derive(Clone, Debug, Default)]
pub struct Strokes {
    pub knife: Vec<Line>,
    pub sewn: Vec<Line>,
    pub cut: Vec<Line>,
}

fn closed(mut line: Line) -> Line {
    line.extend(line.first().copied());
    line
}

/// A DXF in millimetres: layers CUT and NOTCH are cut.
pub fn dxf(text: &str) -> Strokes {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let mut by_layer: BTreeMap<String, Vec<(Line, bool)>> = BTreeMap::new();
    let (mut kind, mut layer, mut at) = ("", "", Vec2::zeros());
    for pair in lines.chunks(2) {
        match (pair[0], pair[1]) {
            ("0", value) => kind = value,
            ("8", value) => {
                layer = value;
                if kind == "POLYLINE" {
                    by_layer
                        .entry(layer.into())
                        .or_default()
                        .push((Vec::new(), false));
                }
            }
            ("70", value) if kind == "POLYLINE" => {
                by_layer.get_mut(layer).unwrap().last_mut().unwrap().1 =
                    value.parse::<u32>().unwrap() & 1 == 1;
            }
            ("10", value) => at.x = value.parse().unwrap(),
            ("20", value) if kind == "VERTEX" => {
                at.y = value.parse().unwrap();
                by_layer
                    .get_mut(layer)
                    .unwrap()
                    .last_mut()
                    .unwrap()
                    .0
                    .push(at * 1e-3);
            }
            _ => {}
        }
    }
    let of = |layer: &str| by_layer.get(layer).cloned().unwrap_or_default();
    let drawn = |(line, is_closed): (Line, bool)| if is_closed { closed(line) } else { line };
    let knife = [of("CUT"), of("NOTCH")].concat();
    Strokes {
        knife: knife.into_iter().map(drawn).collect(),
        sewn: of("SEW").into_iter().map(|line| line.0).collect(),
        cut: of("CUT").into_iter().map(|line| line.0).collect(),
    }
}

/// What pen 1 of a plot draws (m).
pub fn hpgl(text: &str) -> Vec<Line> {
    let (mut lines, mut pen, mut unit): (Vec<Line>, &str, f64) = (Vec::new(), "", 0.0);
    let mut at = Vec2::zeros();
    for command in text.split(';').map(str::trim).filter(|c| c.len() > 1) {
        let (name, rest) = command.split_at(2);
        let numbers: Vec<f64> = rest.split(',').filter_map(|n| n.parse().ok()).collect();
        let mut points = numbers.chunks_exact(2).map(|p| Vec2::new(p[0], p[1]));
        match name {
            "IP" => unit = (numbers[2] - numbers[0]) * 25e-6,
            "SC" => unit /= numbers[1] - numbers[0],
            "SP" => pen = rest,
            "PU" => {
                at = points.next_back().unwrap_or(at);
                lines.push(vec![at * unit]);
            }
            "PD" => {
                for point in points {
                    at = point;
                    if pen == "1" {
                        lines.last_mut().unwrap().push(at * unit);
                    }
                }
            }
            _ => {}
        }
    }
    lines.retain(|line| line.len() > 1);
    lines
}

fn attribute<'t>(element: &'t str, name: &str) -> Option<&'t str> {
    let start = element.find(&format!(" {name}=\""))? + name.len() + 3;
    element[start..].split('"').next()
}

/// Lines of a path of M, L and Z, and whether each is closed; in millimetres.
fn path(d: &str) -> Vec<(Line, bool)> {
    let parts = d.split('M').filter(|part| !part.is_empty());
    let line = |part: &str| {
        let corner = |corner: &str| {
            let mut numbers = corner.split_whitespace().map(|n| n.parse::<f64>().unwrap());
            Vec2::new(numbers.next().unwrap(), numbers.next().unwrap()) * 1e-3
        };
        let corners = part.trim_end_matches('Z').split('L').map(corner);
        (corners.collect(), part.ends_with('Z'))
    };
    parts.map(line).collect()
}

/// An SVG in millimetres: what is drawn as the lines of class cut are, is cut.
pub fn svg(text: &str) -> Strokes {
    let paths: Vec<&str> = text
        .lines()
        .filter(|line| line.starts_with("<path"))
        .collect();
    let class = |path: &str| attribute(path, "class").unwrap_or("").to_owned();
    let look = |path: &str| {
        ["stroke", "stroke-width", "stroke-dasharray"].map(|a| attribute(path, a).map(String::from))
    };
    let bold: Vec<_> = paths
        .iter()
        .filter(|p| class(p) == "cut")
        .map(|p| look(p))
        .collect();
    let mut strokes = Strokes::default();
    for element in paths {
        let class = class(element);
        let lines = path(attribute(element, "d").unwrap());
        if class == "sew" {
            strokes.sewn.extend(lines.iter().map(|line| line.0.clone()));
        }
        if class == "cut" {
            strokes.cut.extend(lines.iter().map(|line| line.0.clone()));
        }
        if class == "cut"
            || class == "notch"
            || (!class.is_empty() && bold.contains(&look(element)))
        {
            let drawn = |(line, is_closed)| if is_closed { closed(line) } else { line };
            strokes.knife.extend(lines.into_iter().map(drawn));
        }
    }
    strokes
}

/// A PDF of one page: what is drawn as the lines of kind CUT are, is cut.
pub fn pdf(bytes: &[u8]) -> Strokes {
    let text = String::from_utf8_lossy(bytes);
    let unit = text.split("/UserUnit ").nth(1);
    let unit: f64 = unit.map_or(1.0, |u| {
        u.split_whitespace().next().unwrap().parse().unwrap()
    });
    let metres = unit * 0.0254 / 72.0;
    let mut kinds: Vec<String> = Vec::new();
    let (mut look, mut lines) = ([""; 3].map(String::from), Vec::<(Line, bool)>::new());
    let mut drawn: Vec<(String, [String; 3], (Line, bool))> = Vec::new();
    for row in text.lines() {
        let words: Vec<&str> = row.split_whitespace().collect();
        let point = |x: &str, y: &str| Vec2::new(x.parse().unwrap(), y.parse().unwrap()) * metres;
        match words[..] {
            [kind, "BMC"] => kinds.push(kind.trim_start_matches('/').to_owned()),
            [_, _, "BDC"] => kinds.push(String::new()),
            ["EMC"] => drop(kinds.pop()),
            [.., "RG"] => look[0] = row.to_owned(),
            [.., "w"] => look[1] = row.to_owned(),
            [.., "d"] => look[2] = row.to_owned(),
            [x, y, "m"] => lines.push((vec![point(x, y)], false)),
            [x, y, "l"] => lines.last_mut().unwrap().0.push(point(x, y)),
            ["h"] => lines.last_mut().unwrap().1 = true,
            ["S"] => {
                let kind = kinds.last().cloned().unwrap_or_default();
                let all = std::mem::take(&mut lines);
                drawn.extend(
                    all.into_iter()
                        .map(|line| (kind.clone(), look.clone(), line)),
                );
            }
            ["f*" | "f" | "n" | "W"] => lines.clear(),
            _ => {}
        }
    }
    let bold: Vec<_> = drawn
        .iter()
        .filter(|d| d.0 == "CUT")
        .map(|d| d.1.clone())
        .collect();
    let mut strokes = Strokes::default();
    for (kind, look, (line, is_closed)) in drawn {
        if kind == "SEW" {
            strokes.sewn.push(line.clone());
        }
        if kind == "CUT" {
            strokes.cut.push(line.clone());
        }
        if kind == "CUT" || kind == "NOTCH" || (!kind.is_empty() && bold.contains(&look)) {
            strokes
                .knife
                .push(if is_closed { closed(line) } else { line });
        }
    }
    strokes
}
