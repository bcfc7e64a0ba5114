//! Lines read back from files, by readers that share no code with the writers.

use toile_geometry::{EdgeTree, Polygon, Vec2};

/// How far a point of a line lies from a border at the most (m).
pub fn hausdorff(points: &[Vec2], border: &Polygon) -> f64 {
    let tree = EdgeTree::of(border);
    let off = |p: &Vec2| {
        let own = EdgeTree::new(vec![[*p, *p]]);
        own.distance(&tree)
    };
    points.iter().map(off).fold(0.0, f64::max)
}

/// The polylines of a layer of a DXF (m).
pub fn dxf_lines(text: &str, layer: &str) -> Vec<Vec<Vec2>> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found: Vec<Vec<Vec2>> = Vec::new();
    let (mut kind, mut own, mut x) = ("", false, 0.0);
    for pair in lines.chunks(2) {
        match (pair[0].trim(), pair[1]) {
            ("0", value) => kind = value,
            ("8", value) => {
                own = value == layer;
                if own && kind == "POLYLINE" {
                    found.push(Vec::new());
                }
            }
            ("10", value) => x = value.parse().unwrap(),
            ("20", value) if own && kind == "VERTEX" => {
                let y: f64 = value.parse().unwrap();
                found.last_mut().unwrap().push(Vec2::new(x, y) * 1e-3);
            }
            _ => {}
        }
    }
    found
}

/// The lines of the paths of an SVG that have some text in their element, each subpath a line (m).
pub fn svg_paths(text: &str, marked: &str) -> Vec<Vec<Vec2>> {
    let mut found = Vec::new();
    for line in text
        .lines()
        .filter(|l| l.contains("<path") && l.contains(marked))
    {
        let d = line
            .split(" d=\"")
            .nth(1)
            .unwrap()
            .split('"')
            .next()
            .unwrap();
        found.extend(subpaths(d));
    }
    found
}

/// Subpaths of M, L and Z.
pub fn subpaths(d: &str) -> Vec<Vec<Vec2>> {
    let parts = d.split('M').filter(|part| !part.is_empty());
    let points = |part: &str| {
        let corners = part.trim_end_matches('Z').split('L');
        let corner = |corner: &str| {
            let mut numbers = corner.split_whitespace().map(|n| n.parse::<f64>().unwrap());
            Vec2::new(numbers.next().unwrap(), numbers.next().unwrap()) * 1e-3
        };
        corners.map(corner).collect()
    };
    parts.map(points).collect()
}
