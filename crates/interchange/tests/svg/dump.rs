use crate::{back, drafted, read};
#[test]
fn dump() {
    let _ = std::fs::create_dir_all("/tmp/svgout");
    for name in [
        "simon_cisMaleAdult40_sa10mm",
        "teagan_cisMaleAdult36_sa10mm",
        "brian_cisMaleAdult40_sa10mm",
        "bella_cisFemaleAdult34_sa10mm",
    ] {
        let text =
            std::fs::read_to_string(format!("/work/shared/data/freesewing/{name}.svg")).unwrap();
        let reading = read(&text).unwrap();
        let draft = drafted(&reading.pattern, None);
        for panel in &reading.pattern.panels {
            let piece = draft
                .pieces
                .iter()
                .find(|p| p.id.panel == panel.id)
                .unwrap();
            println!("== {name} {} notches {}", panel.name, panel.notches.len());
            for edge in piece.outline.iter().filter(|e| e.origin.half == 0) {
                let (a, b) = (edge.curve.start() * 1e3, edge.curve.end() * 1e3);
                println!(
                    "   {:.2},{:.2} -> {:.2},{:.2} len {:.1} sa {:.3} corner {:?}",
                    a.x,
                    a.y,
                    b.x,
                    b.y,
                    edge.curve.length() * 1e3,
                    edge.seam_allowance * 1e3,
                    edge.corner.kind
                );
            }
            for n in &panel.notches {
                println!("   notch {:?} {:?}", n.at, n.kind);
            }
            for n in &piece.notches {
                println!(
                    "   at {:.2},{:.2} {:?}",
                    n.point.x * 1e3,
                    n.point.y * 1e3,
                    n.edge.half
                );
            }
        }
        for d in reading
            .pattern
            .resolve(&toile_measure::Measurements::adult())
            .1
        {
            println!("  DIAG {d:?}");
        }
        match back::svg_of(&reading.pattern, None) {
            Some(svg) => std::fs::write(format!("/tmp/svgout/{name}.svg"), svg).unwrap(),
            None => println!("  not written"),
        }
    }
}
