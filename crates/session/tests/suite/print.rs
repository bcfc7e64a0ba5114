//! Prints read back by another library: pages, sizes, layers, the box to measure, sheets joined by
//! their marks.

use crate::pdf_back::{Line, Page, layers, pages};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use toile_geometry::{EdgeTree, Polygon, Vec2};
use toile_interchange::PrintJob;
use toile_session::{
    BodyChoice, Lines, Paper, PrintOptions, Project, SessionError, Silent, SizeSelection,
    print_job, print_pattern,
};

const SAIL: &str = include_str!("support/sail.toile.json");

/// 0.01 mm.
const FINE: f64 = 1e-5;
/// Widths of the lines of a print (m).
const CUT: f64 = 0.0005;
const SEW: f64 = 0.0002;
const JOIN: f64 = 0.000_15;

const NAMES: [&str; 5] = ["dress", "gathered-skirt", "poncho", "t-shirt", "trousers"];

fn pattern(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../patterns");
    folder.join(format!("{name}.toile.json"))
}

fn project(name: &str) -> Project {
    Project::open(&pattern(name)).unwrap().0
}

fn job(name: &str, options: &PrintOptions) -> PrintJob {
    print_job(&project(name), options, &mut Silent).unwrap().0
}

fn is_wide(line: &Line, width: f64) -> bool {
    (line.width - width).abs() < 0.2 * JOIN
}

/// The boxes of 100 x 50 mm on a page.
fn test_boxes(page: &Page) -> usize {
    let is_box = |line: &&Line| {
        let [a, b, c, d] = line.points[..] else {
            return false;
        };
        let sides = [b - a, c - b, d - c, a - d];
        let wanted = [[0.1, 0.0], [0.0, 0.05], [-0.1, 0.0], [0.0, -0.05]];
        let meets = |(side, wanted): (&Vec2, [f64; 2])| (side - Vec2::from(wanted)).norm() < FINE;
        line.closed && sides.iter().zip(wanted).all(meets)
    };
    page.lines.iter().filter(is_box).count()
}

#[test]
fn every_paper_has_its_pages_layers_and_a_box_to_measure() {
    for sizes in [SizeSelection::Base, SizeSelection::All] {
        for paper in Paper::ALL {
            let options = PrintOptions {
                sizes: sizes.clone(),
                paper,
                ..PrintOptions::default()
            };
            let job = job("t-shirt", &options);
            let (tiles, bytes) = (job.tiles().unwrap(), job.pdf().unwrap());
            let read = pages(&bytes);
            assert_eq!(read.len(), tiles.len(), "{paper:?}");
            for (page, tile) in read.iter().zip(&tiles) {
                assert!((page.size - tile.sheet).norm() < FINE, "{paper:?}");
                // A blank page has its frame, crosses and name alone.
                let own = page.lines.iter().filter(|line| !is_wide(line, JOIN));
                assert!(own.count() > 0, "{paper:?} {:?} is blank", tile.place);
            }
            if let Some(sheet) = paper.sheet() {
                assert!((read[0].size - sheet).norm() < FINE);
                let place = format!("row {}, column {}", tiles[0].place[0], tiles[0].place[1]);
                assert!(read[0].words.iter().any(|w| w.starts_with(&place)));
            } else {
                assert_eq!(read.len(), 1);
            }
            let boxes: usize = read.iter().map(test_boxes).sum();
            assert_eq!(boxes, 1, "{paper:?}");
            let words = read.iter().flat_map(|page| &page.words);
            assert_eq!(
                words.filter(|w| *w == "50 x 100 mm").count(),
                1,
                "{paper:?}"
            );
            let wanted: Vec<&str> = match sizes {
                SizeSelection::All => vec!["XS", "S", "M", "L", "XL", "XXL"],
                _ => vec!["M"],
            };
            let wanted: Vec<String> = wanted.iter().map(|s| format!("size {s}")).collect();
            assert_eq!(layers(&bytes), wanted);
            let svg = job.svg().unwrap();
            let layer = "inkscape:groupmode=\"layer\"";
            assert_eq!(svg.matches(layer).count(), wanted.len() + 1, "{paper:?}");
            assert_eq!(svg.matches("<inkscape:page ").count(), tiles.len());
            for name in &wanted {
                assert!(
                    svg.contains(&format!("inkscape:label=\"{name}\"")),
                    "{name}"
                );
            }
            if paper == Paper::Projector {
                let thin = read[0]
                    .lines
                    .iter()
                    .find(|line| line.layer.is_some() && line.width < 0.001);
                assert!(thin.is_none(), "{thin:?}");
            }
        }
    }
}

/// The lines to cut along as they lie on the drawing, by layer.
fn wanted(job: &PrintJob) -> Vec<(String, Polygon)> {
    let mut all = Vec::new();
    for piece in &job.pieces {
        for (layer, cut) in &piece.sizes {
            let name = job.layers[*layer].name.clone();
            let place = |p: Vec2| piece.pose.apply(p * job.scale);
            all.push((name, cut.polygon().mapped(place)));
        }
    }
    all
}

/// How far from any of some segments a point lies.
fn farthest<'a>(points: impl Iterator<Item = &'a Vec2>, tree: &EdgeTree) -> f64 {
    let off = |p: &Vec2| EdgeTree::new(vec![[*p, *p]]).distance(tree);
    points.map(off).fold(0.0, f64::max)
}

fn segments(line: &Line) -> Vec<[Vec2; 2]> {
    let mut pairs: Vec<[Vec2; 2]> = line.points.windows(2).map(|p| [p[0], p[1]]).collect();
    if line.closed {
        pairs.push([line.points[line.points.len() - 1], line.points[0]]);
    }
    pairs
}

/// Cut lines read, moved, against those wanted, layer by layer.
fn compare(job: &PrintJob, lines: &[Line], within: f64, what: &str) {
    let wanted = wanted(job);
    for layer in &job.layers {
        let own = |line: &&Line| line.layer.as_deref() == Some(&layer.name) && is_wide(line, CUT);
        let found: Vec<[Vec2; 2]> = lines.iter().filter(own).flat_map(segments).collect();
        let meant = wanted.iter().filter(|(name, _)| *name == layer.name);
        let meant: Vec<[Vec2; 2]> = meant.flat_map(|(_, p)| p.edges()).collect();
        assert!(
            !found.is_empty() && !meant.is_empty(),
            "{what} {}",
            layer.name
        );
        let to_meant = farthest(found.iter().flatten(), &EdgeTree::new(meant.clone()));
        let to_found = farthest(meant.iter().flatten(), &EdgeTree::new(found.clone()));
        let off = to_meant.max(to_found);
        assert!(off < within, "{what} {}: {off}", layer.name);
        let length = |all: &[[Vec2; 2]]| all.iter().map(|s| (s[1] - s[0]).norm()).sum::<f64>();
        assert!(
            length(&found) >= length(&meant) - 1e-3,
            "{what}: a line has gaps"
        );
    }
}

#[test]
fn cut_lines_of_all_patterns_and_sizes_are_in_the_print() {
    for name in NAMES {
        let options = PrintOptions {
            sizes: SizeSelection::All,
            paper: Paper::Page,
            ..PrintOptions::default()
        };
        let job = job(name, &options);
        let page = &pages(&job.pdf().unwrap())[0];
        let shift = job.tiles().unwrap()[0].shift;
        let moved = page.lines.iter().map(|line| Line {
            points: line.points.iter().map(|p| p - shift).collect(),
            ..line.clone()
        });
        compare(&job, &moved.collect::<Vec<_>>(), 2e-5, name);
    }
}

/// Where the crosses of a sheet are: the middles of level and upright strokes that meet.
fn crosses(page: &Page) -> Vec<Vec2> {
    let arms = page
        .lines
        .iter()
        .filter(|line| is_wide(line, JOIN) && !line.closed);
    let middle = |line: &Line| (line.points[0] + line.points[1]) * 0.5;
    let level = arms.filter(|line| (line.points[0].y - line.points[1].y).abs() < FINE);
    level.map(middle).collect()
}

/// Row and column that a sheet names.
fn place(page: &Page) -> [f64; 2] {
    let words = page.words.iter().find(|w| w.starts_with("row ")).unwrap();
    let numbers: Vec<f64> = words
        .split(|c: char| !c.is_ascii_digit())
        .filter_map(|n| n.parse().ok())
        .collect();
    [numbers[0], numbers[1]]
}

#[test]
fn sheets_joined_by_their_marks_give_the_outlines() {
    for (name, paper, sizes) in [
        ("t-shirt", Paper::A4, SizeSelection::Base),
        ("trousers", Paper::Letter, SizeSelection::All),
        ("gathered-skirt", Paper::A0, SizeSelection::one("XL")),
    ] {
        let options = PrintOptions {
            sizes,
            paper,
            ..PrintOptions::default()
        };
        let job = job(name, &options);
        let sheets = pages(&job.pdf().unwrap());
        let mut lines = Vec::new();
        for sheet in &sheets {
            let crosses = crosses(sheet);
            assert_eq!(crosses.len(), 8, "{name}");
            let low = crosses.iter().fold(crosses[0], |a, b| a.inf(b));
            let high = crosses.iter().fold(crosses[0], |a, b| a.sup(b));
            let [row, column] = place(sheet);
            let step = high - low;
            let joined = Vec2::new((column - 1.0) * step.x, -(row - 1.0) * step.y);
            lines.extend(sheet.lines.iter().map(|line| Line {
                points: line.points.iter().map(|p| p - high + joined).collect(),
                ..line.clone()
            }));
        }
        // The upper right cross of the first sheet lies 5 mm inside its window's corner.
        let window = paper.window().unwrap();
        let corner = Vec2::new(window.x - 0.005, job.size.y - 0.005);
        for line in &mut lines {
            line.points.iter_mut().for_each(|p| *p += corner);
        }
        compare(&job, &lines, 1e-4, name);
    }
}

/// Words that lie across a joint are on more than one sheet.
#[test]
fn the_name_of_a_piece_lies_on_one_sheet() {
    for paper in [Paper::A4, Paper::Letter] {
        for name in NAMES {
            let options = PrintOptions {
                paper,
                ..PrintOptions::default()
            };
            let job = job(name, &options);
            let read = pages(&job.pdf().unwrap());
            for piece in &job.pieces {
                let own = |page: &Page| page.words.iter().filter(|w| **w == piece.words[0]).count();
                let sheets: Vec<usize> = read.iter().map(own).filter(|count| *count > 0).collect();
                assert_eq!(sheets, [1], "{name} {paper:?} {}", piece.words[0]);
            }
            // Each has its grain line, by name.
            let grain = read.iter().flat_map(|page| &page.words);
            assert!(
                grain.filter(|w| *w == "grain").count() >= job.pieces.len(),
                "{name}"
            );
        }
    }
}

#[test]
fn lines_scale_pieces_and_halves_are_as_asked() {
    let whole = PrintOptions::default();
    let only = |options: &PrintOptions| pages(&job("t-shirt", options).pdf().unwrap());
    let count = |sheets: &[Page], width: f64| {
        let lines = sheets.iter().flat_map(|sheet| &sheet.lines);
        lines
            .filter(|l| l.layer.is_some() && is_wide(l, width))
            .count()
    };
    for (lines, cut, sew) in [
        (Lines::Both, true, true),
        (Lines::Cut, true, false),
        (Lines::Sew, false, true),
    ] {
        let sheets = only(&PrintOptions {
            lines,
            ..whole.clone()
        });
        assert_eq!(count(&sheets, CUT) > 0, cut, "{lines:?}");
        assert_eq!(count(&sheets, SEW) > 0, sew, "{lines:?}");
    }
    let quarter = PrintOptions {
        scale: 0.25,
        ..whole.clone()
    };
    let small = job("t-shirt", &quarter);
    let large = job("t-shirt", &whole);
    let area = |job: &PrintJob| wanted(job).iter().map(|w| w.1.area()).sum::<f64>();
    assert!((area(&large) / area(&small) - 16.0).abs() < 1e-9);
    let sheets = pages(&small.pdf().unwrap());
    assert_eq!(sheets.iter().map(test_boxes).sum::<usize>(), 1);
    let words: Vec<&String> = sheets.iter().flat_map(|s| &s.words).collect();
    assert!(words.iter().any(|w| w.contains("scale 1:4")), "{words:?}");
    assert!(sheets.len() < large.tiles().unwrap().len());
    let halves = job(
        "t-shirt",
        &PrintOptions {
            halves: true,
            ..whole.clone()
        },
    );
    assert!(area(&halves) < 0.8 * area(&large));
    let front = PrintOptions {
        pieces: vec!["front".into()],
        ..whole
    };
    assert_eq!(job("t-shirt", &front).pieces.len(), 1);
}

#[test]
fn a_print_says_how_far_it_is_and_stops() {
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().join("shirt.pdf");
    let mut shares = Vec::new();
    let mut follow = |_: &str, share: f64, _: &str| {
        shares.push(share);
        ControlFlow::Continue(())
    };
    let paths = (&project("t-shirt"), &*to);
    let options = PrintOptions::default();
    let printed = print_pattern(paths, &options, &mut follow).unwrap();
    assert!(
        shares.windows(2).all(|pair| pair[0] <= pair[1]),
        "{shares:?}"
    );
    assert_eq!(printed.sizes, ["M"]);
    assert!(printed.cut_list[0].area() > 0.5);
    let bytes = std::fs::read(&to).unwrap();
    assert_eq!(pages(&bytes).len(), printed.tiles.len());
    // The same print gives the same bytes.
    assert_eq!(job("t-shirt", &options).pdf().unwrap(), bytes);
    std::fs::remove_file(&to).unwrap();
    let mut stop = |stage: &str, _: f64, _: &str| match stage {
        "arranging" => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    };
    let stopped = print_pattern(paths, &options, &mut stop);
    assert!(matches!(stopped, Err(SessionError::Cancelled)));
    assert!(!to.exists());
}

#[test]
fn what_is_not_there_is_refused_by_its_name() {
    let refused = |options: PrintOptions, said: &str| {
        let Err(error) = print_job(&project("t-shirt"), &options, &mut Silent) else {
            panic!("not refused: {said}");
        };
        assert!(
            error.is_bad_input() && error.to_string().contains(said),
            "{error}"
        );
    };
    let usual = PrintOptions::default;
    refused(
        PrintOptions {
            sizes: SizeSelection::one("XXXL"),
            ..usual()
        },
        "XXXL",
    );
    refused(
        PrintOptions {
            pieces: vec!["collar".into()],
            ..usual()
        },
        "collar",
    );
    refused(
        PrintOptions {
            scale: 0.001,
            ..usual()
        },
        "1:100",
    );
    refused(
        PrintOptions {
            scale: f64::NAN,
            ..usual()
        },
        "1:100",
    );
    // A sail of 40 by 40 m.
    let folder = tempfile::tempdir().unwrap();
    let sail = folder.path().join("sail.toile.json");
    std::fs::write(&sail, SAIL).unwrap();
    let Err(error) = print_job(&Project::open(&sail).unwrap().0, &usual(), &mut Silent) else {
        panic!("a sail is printed on sheets of A4");
    };
    assert!(error.to_string().contains("more than 500"), "{error}");
    let paths = (&project("t-shirt"), Path::new("shirt.ps"));
    let error = print_pattern(paths, &usual(), &mut Silent).unwrap_err();
    assert!(
        error.to_string().contains("NAME.pdf or NAME.svg"),
        "{error}"
    );
}

#[test]
fn paper_says_which_style_and_size_it_is_or_whom_it_is_made_for() {
    let options = PrintOptions::default();
    let sized = job("dress", &options);
    let said = |job: &PrintJob, words: &str| job.title.facts.iter().any(|f| f.starts_with(words));
    assert!(said(&sized, "size M, true size"), "{:?}", sized.title);
    for piece in &sized.pieces {
        assert_eq!(piece.words[1..3], ["Dress", "size M"]);
    }
    let measured = Project {
        body: BodyChoice::Measured {
            figure: toile_session::Figure::Woman,
            path: Some("people/anna.measurements.json".into()),
            measurements: std::sync::Arc::new(toile_session::Figure::Woman.average()),
        },
        ..project("dress")
    };
    let (made, _) = print_job(&measured, &options, &mut Silent).unwrap();
    assert!(
        said(&made, "Made to measure for anna, true size"),
        "{:?}",
        made.title
    );
    assert!(said(&made, "bust "), "{:?}", made.title);
    assert!(made.title.facts[1].contains("hips "), "{:?}", made.title);
    for piece in &made.pieces {
        assert_eq!(piece.words[1..3], ["Dress", "made for anna"]);
    }
    // In a size of the pattern it is made for nobody else.
    let sizes = SizeSelection::one("M");
    let (sized, _) = print_job(&measured, &PrintOptions { sizes, ..options }, &mut Silent).unwrap();
    assert!(said(&sized, "size M, true size"), "{:?}", sized.title);
}
