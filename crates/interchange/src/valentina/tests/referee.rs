//! Areas of pieces of the shared samples against those that Valentina 0.7.52 exports.

use super::pieces::samples;
use super::{evaluated, read_valentina};
use crate::exchange::Companion;
use toile_geometry::Curve;

/// A file, its measurements, and its pieces with the areas inside their seam lines (cm2).
type Row = (
    &'static str,
    Option<&'static str>,
    &'static [(&'static str, f64)],
);

/// Areas measured from the seam lines that Valentina writes as DXF; its curves are chords.
const MEASURED: &[Row] = &[
    (
        "MaleShirt.val",
        Some("MaleShirt.vit"),
        &[
            ("PocketFlap", 27.0),
            ("PlacketTop", 102.4884),
            ("ShortSleeve", 1349.2752),
            ("CollarTop", 92.6781),
            ("CollarTopInterface", 114.187),
            ("PocketRound", 155.2806),
            ("Yoke", 221.0866),
            ("PocketFlapRound", 32.9052),
            ("BackPanel", 2071.8818),
            ("CollarBaseInterface", 78.0098),
            ("PlacketUnder", 45.6192),
            ("CuffInterface", 174.0),
            ("FullSleeve", 2384.4612),
            ("CollarBase", 78.0098),
            ("Collar", 174.0),
            ("FrontPanel", 2378.8058),
            ("Pocket", 148.5),
        ],
    ),
    (
        "Keiko_skirt.val",
        Some("keiko.vit"),
        &[("Detail", 1235.0062), ("Detail 2", 1244.1399)],
    ),
    (
        "Sleeve.val",
        Some("GOST_man_ru.vst"),
        &[("Detail", 2111.894)],
    ),
    ("TestDart.val", None, &[("Detail", 849.6277)]),
];
/// Pieces that may differ by more.
const ALLOWED: usize = 1;

#[test]
#[allow(clippy::print_stdout)]
fn areas_of_shared_samples_are_those_that_valentina_exports() {
    let Some(folder) = samples() else {
        println!("skipped: there is no folder of shared samples");
        return;
    };
    let (mut count, mut others) = (0, Vec::new());
    for (file, body, pieces) in MEASURED {
        let folder = folder.join("valentina");
        let text = std::fs::read_to_string(folder.join(file)).unwrap();
        let companions: Vec<Companion> = body
            .iter()
            .map(|body| Companion {
                name: (*body).to_owned(),
                bytes: std::fs::read(folder.join(body)).unwrap(),
            })
            .collect();
        let reading = read_valentina(&text, &companions).unwrap();
        let evaluation = evaluated(&reading);
        for (name, wanted) in *pieces {
            let panel = reading.pattern.panel_named(name);
            let panel = panel.unwrap_or_else(|| panic!("{file}: no piece {name:?}"));
            let edges = panel.outline().unwrap().edges.iter();
            let paths = edges.map(|edge| evaluation.edge(edge.id).unwrap());
            let swept = paths.flat_map(|path| path.curves()).map(Curve::swept_area);
            let found = swept.sum::<f64>() / 2.0 * 1e4;
            count += 1;
            if (found - wanted).abs() > 0.02_f64.max(0.002 * wanted) {
                others.push(format!("{file}, {name}: {found:.4}, not {wanted}"));
            }
        }
    }
    assert_eq!(count, 21);
    assert!(others.len() <= ALLOWED, "{others:#?}");
}
