//! Whole garments: every shipped pattern, and foreign ones where they are present, from file to
//! worn.

use std::path::PathBuf;
use toile_drape::{GarmentRun, Stage};
use toile_session::{Command, Figure, OtherGarment, Quality, Session, Silent};
use toile_tests::{files_below, root, shared_data};

/// Sews and drapes a pattern in a size, or the base size, at preview quality and holds it to what
/// every garment must meet.
fn check(path: PathBuf, size: Option<&str>) {
    let name = path
        .file_name()
        .map(|n| format!("{}, {size:?}", n.to_string_lossy()))
        .unwrap_or_default();
    let mut session = Session::new();
    let size = size.map(|name| Command::SetSize {
        size: Some(name.to_owned()),
    });
    let commands = [
        Some(Command::open(path)),
        size,
        Some(Command::SetQuality {
            quality: Quality::Preview,
        }),
        Some(Command::Check),
        Some(Command::Nest),
    ];
    for command in commands.into_iter().flatten() {
        session
            .execute(command, &mut Silent)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
    }
    let job = session
        .garment_setup()
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    let mut run = GarmentRun::new(job.setup).unwrap_or_else(|error| panic!("{name}: {error}"));
    while run.progress().stage != Stage::Finished {
        run.advance()
            .unwrap_or_else(|error| panic!("{name}: {error}"));
    }
    let measures = run.measure();
    let mesh = run.system.mesh(&run.state.positions);
    assert_eq!(mesh.component_count(), 1, "{name}: one merged object");
    assert_eq!(
        mesh.topology().non_manifold().count(),
        0,
        "{name}: edge-manifold"
    );
    assert!(
        run.gap_before_merging() <= 1e-3,
        "{name}: gap {}",
        run.gap_before_merging()
    );
    assert!(
        measures.residual <= 1e-2,
        "{name}: residual {}",
        measures.residual
    );
    assert_eq!(measures.body_intersections, 0, "{name}");
    assert_eq!(measures.self_intersections, 0, "{name}");
    for direction in 0..2 {
        assert!(
            measures.strain_p99[direction] <= 0.05,
            "{name}: {measures:?}"
        );
        assert!(
            measures.strain_max[direction] <= 0.15,
            "{name}: {measures:?}"
        );
    }
}

#[test]
fn shipped_patterns_are_worn() {
    let patterns = files_below(&root().join("patterns"), ".toile.json");
    assert_eq!(patterns.len(), 5);
    for path in patterns {
        check(path, None);
    }
}

#[test]
fn the_smallest_and_largest_size_are_worn() {
    for name in ["dress", "trousers"] {
        for size in ["XS", "XXL"] {
            check(
                root().join(format!("patterns/{name}.toile.json")),
                Some(size),
            );
        }
    }
}

#[test]
fn foreign_patterns_are_worn() {
    let Some(data) = shared_data() else { return };
    let patterns = files_below(&data.join("garmentcode"), "_specification.json");
    assert!(!patterns.is_empty());
    for path in patterns {
        check(path, None);
    }
}

#[test]
fn shipped_patterns_are_worn_over_one_another() {
    let path = |name: &str| root().join(format!("patterns/{name}.toile.json"));
    let over = |name: &str, layer| OtherGarment {
        path: path(name),
        layer,
    };
    let mut session = Session::new();
    for command in [
        Command::open(path("trousers")),
        Command::SetLayers {
            layer: 1,
            others: vec![over("t-shirt", 2), over("poncho", 3)],
        },
        Command::SetBody {
            figure: Some(Figure::Woman),
            measurements: None,
        },
        Command::SetQuality {
            quality: Quality::Preview,
        },
    ] {
        session.execute(command, &mut Silent).unwrap();
    }
    let job = session.garment_setup().unwrap();
    let mut run = GarmentRun::new(job.setup).unwrap();
    while run.progress().stage != Stage::Finished {
        run.advance().unwrap();
    }
    let measures = run.measure();
    assert_eq!(measures.body_intersections, 0);
    assert_eq!(measures.self_intersections, 0);
    assert_eq!(measures.layers.len(), 3);
    for layer in &measures.layers {
        assert_eq!([layer.outer_intersections, layer.astray], [0; 2]);
    }
    let mesh = run.system.mesh(&run.state.positions);
    assert_eq!(mesh.component_count(), 3);
    assert!(run.findings().is_empty(), "{:?}", run.findings());
}
