//! Pages of a PDF read back by another library: sizes, layers, lines, words.

use lopdf::content::Content;
use lopdf::{Document, Object};
use toile_geometry::Vec2;

/// A point of a PDF (m).
const POINT: f64 = 0.0254 / 72.0;

/// A line on a page.
#[derive(Clone, Debug)]
pub struct Line {
    /// The layer it is on.
    pub layer: Option<String>,
    /// (m)
    pub width: f64,
    pub closed: bool,
    /// (m)
    pub points: Vec<Vec2>,
}

/// A page.
#[derive(Clone, Debug)]
pub struct Page {
    /// (m)
    pub size: Vec2,
    pub lines: Vec<Line>,
    pub words: Vec<String>,
}

fn number(object: &Object) -> f64 {
    match object {
        Object::Integer(n) => *n as f64,
        Object::Real(x) => f64::from(*x),
        other => panic!("{other:?} is no number"),
    }
}

/// Names of the layers of a file.
pub fn layers(bytes: &[u8]) -> Vec<String> {
    let file = Document::load_mem(bytes).unwrap();
    let Ok(properties) = file.catalog().unwrap().get(b"OCProperties") else {
        return Vec::new();
    };
    let groups = properties.as_dict().unwrap().get(b"OCGs").unwrap();
    let groups = groups.as_array().unwrap().iter();
    groups.map(|group| layer_name(&file, group)).collect()
}

fn layer_name(file: &Document, group: &Object) -> String {
    let group = file.get_dictionary(group.as_reference().unwrap()).unwrap();
    let name = group.get(b"Name").unwrap().as_str().unwrap();
    String::from_utf8(name.to_vec()).unwrap()
}

/// Every page of a file.
pub fn pages(bytes: &[u8]) -> Vec<Page> {
    let file = Document::load_mem(bytes).unwrap();
    let ids = file.get_pages().into_values();
    ids.map(|id| {
        let page = file.get_dictionary(id).unwrap();
        let unit = page.get(b"UserUnit").map_or(1.0, number) * POINT;
        let sides = page.get(b"MediaBox").unwrap().as_array().unwrap();
        let sides: Vec<f64> = sides.iter().map(number).collect();
        let mut read = Page {
            size: Vec2::new(sides[2] - sides[0], sides[3] - sides[1]) * unit,
            lines: Vec::new(),
            words: Vec::new(),
        };
        let resources = page.get(b"Resources").unwrap().as_dict().unwrap();
        let name = |key: &[u8]| {
            let known = resources.get(b"Properties").unwrap().as_dict().unwrap();
            layer_name(&file, known.get(key).unwrap())
        };
        let content = Content::decode(&file.get_page_content(id)).unwrap();
        // Marked content is nested: a layer holds the kinds of its lines.
        let (mut marked, mut width) = (Vec::<Option<String>>::new(), 0.0);
        let mut path: Vec<(Vec<Vec2>, bool)> = Vec::new();
        for operation in &content.operations {
            let given = &operation.operands;
            let at = || Vec2::new(number(&given[0]), number(&given[1])) * unit;
            match operation.operator.as_str() {
                "BDC" => marked.push(Some(name(given[1].as_name().unwrap()))),
                "BMC" => marked.push(None),
                "EMC" => drop(marked.pop().unwrap()),
                "w" => width = number(&given[0]) * unit,
                "m" => path.push((vec![at()], false)),
                "l" => path.last_mut().unwrap().0.push(at()),
                "h" => path.last_mut().unwrap().1 = true,
                "S" => {
                    let layer = marked.iter().rev().flatten().next();
                    let lines = path.drain(..).map(|(points, closed)| Line {
                        layer: layer.cloned(),
                        width,
                        closed,
                        points,
                    });
                    read.lines.extend(lines);
                }
                "n" => path.clear(),
                "Tj" => {
                    let words = given[0].as_str().unwrap().iter().map(|&b| char::from(b));
                    read.words.push(words.collect());
                }
                _ => {}
            }
        }
        read
    })
    .collect()
}
