//! Seams in every size: each within its ease, or named.

use std::path::Path;
use std::sync::Arc;
use toile_pattern::{Number, PointRule};
use toile_session::{Command, Project, Session, SizeSelection, seams_in_sizes};

fn opened(name: &str) -> Session {
    let file = format!("../../patterns/{name}.toile.json");
    let mut session = Session::new();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    session
        .execute(Command::open(path), &mut toile_session::Silent)
        .unwrap();
    session
}

#[test]
fn every_seam_in_every_size_is_within_its_ease_or_named() {
    for name in ["t-shirt", "trousers", "dress"] {
        let session = opened(name);
        let project = session.project();
        let seams = seams_in_sizes(project, &SizeSelection::All).unwrap();
        assert!(!seams.is_empty());
        let found = session
            .diagnostics_by_size(Some(&SizeSelection::All))
            .unwrap();
        for seam in &seams {
            assert_eq!(
                seam.sizes.len(),
                project.pattern.sizes.len().max(1),
                "{name}"
            );
            for sized in &seam.sizes {
                let [first, second] = sized.lengths_mm;
                assert!((first - second - sized.ease_mm).abs() < 1e-9);
                let named = found.iter().any(|told| {
                    told.diagnostic
                        .message
                        .contains(&format!("{:?}", seam.name))
                        && told
                            .sizes
                            .iter()
                            .any(|size| Some(size) == sized.size.as_ref())
                });
                assert!(sized.within || named, "{name}, {}: {sized:?}", seam.name);
            }
            let base = project.pattern.base().map(|size| size.name.clone());
            let own = seam.sizes.iter().find(|sized| sized.size == base).unwrap();
            assert_eq!(own.against_base_mm, Some(0.0));
        }
    }
}

#[test]
fn a_seam_that_grows_apart_in_a_size_is_told() {
    let session = opened("t-shirt");
    let mut project: Project = session.project().clone();
    let pattern = Arc::make_mut(&mut project.pattern);
    let size = pattern.sizes.last().unwrap().clone();
    // In the last size alone the front ends lower at the side seam than the back.
    let sheet = Arc::make_mut(&mut pattern.sheets[0]);
    let points = sheet.points.iter_mut();
    let hem = points
        .map(Arc::make_mut)
        .find(|point| point.name == "hem_side");
    let PointRule::At { y, .. } = &mut hem.unwrap().rule else {
        panic!("the hem ends at a point with coordinates");
    };
    *y = Number::PerSize {
        usual: Box::new(y.clone()),
        sizes: vec![(size.id, -0.85)],
    };
    let seams = seams_in_sizes(&project, &SizeSelection::All).unwrap();
    let uneven: Vec<String> = seams.iter().filter_map(|seam| seam.uneven()).collect();
    assert!(
        uneven.iter().any(|words| words.contains(&size.name)),
        "{uneven:?}"
    );
}
