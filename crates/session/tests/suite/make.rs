//! The whole job on the smallest garment: files, replay, threads, progress, cancelling.

use crate::support::{BAND, band, files, lasting, make};
use std::ops::ControlFlow;
use toile_session::{Command, Event, Quality, Session, SessionError, Silent, open_journal};

const NAMES: [&str; 8] = [
    "drape.png",
    "fit.png",
    "garment.glb",
    "garment.obj",
    "journal.jsonl",
    "marker.json",
    "marker.svg",
    "report.json",
];

#[test]
fn same_input_same_bytes_replayed_and_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let pattern = band(folder.path());
    let place = |name: &str| folder.path().join(name);
    let with_threads = |threads: usize, dir: &str| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let commands = make(&pattern, &place(dir));
        let events = pool
            .install(|| Session::new().execute_all(&commands, &mut Silent))
            .unwrap();
        let warned = |e: &&Event| matches!(e, Event::Warned { .. });
        assert_eq!(events.iter().find(warned), None);
    };
    with_threads(1, "one");
    with_threads(3, "three");
    let first = lasting(&place("one"));
    assert_eq!(first.keys().collect::<Vec<_>>(), NAMES);
    assert_eq!(first, lasting(&place("three")));

    let (journal, notes) = open_journal(&place("one").join("journal.jsonl")).unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    Session::replay(&journal, &place("again"), &mut Silent).unwrap();
    assert_eq!(first, lasting(&place("again")));
    check_report(&first["report.json"]);
    check_glb(&first["garment.glb"], &first["garment.obj"]);
}

fn check_report(bytes: &[u8]) {
    let report: serde_json::Value = serde_json::from_slice(bytes).unwrap();
    assert_eq!(report["components"], 1);
    assert_eq!(report["non_manifold_edges"], 0);
    assert_eq!(report["body_intersections"], 0);
    assert_eq!(report["self_intersections"], 0);
    assert_eq!(report["markers"][0]["sound"], true);
    let number = |name: &str| report[name].as_f64().unwrap();
    assert!(number("residual") <= 1e-2);
    assert!(number("seam_gap_max_m") <= 1e-3);
    assert!(number("kinetic_energy_J") < 1e-6);
    assert_eq!(number("body_penetration_max_m"), 0.0);
    for direction in ["warp", "weft"] {
        assert!(report["strain_p99"][direction].as_f64().unwrap() < 0.05);
        assert!(report["strain_max"][direction].as_f64().unwrap() < 0.15);
    }
    // Two pieces of (84 / 2 + 0.5) cm x 8 cm.
    assert!((number("area_m2") - 2.0 * 0.425 * 0.08).abs() < 1e-12);
    assert_eq!(
        report["seams"][0]["lengths_m"],
        serde_json::json!([0.08, 0.08])
    );
}

/// Every panel is a primitive; distances of its texture coordinates are rest lengths; the OBJ has
/// the same garment, welded.
fn check_glb(glb: &[u8], obj: &[u8]) {
    let file = gltf::Gltf::from_slice(glb).unwrap();
    let blob = file.blob.as_deref().unwrap();
    let obj = toile_interchange::read_obj(obj).unwrap();
    let mesh = file.meshes().next().unwrap();
    assert_eq!(mesh.primitives().len(), 2);
    assert_eq!(obj.groups.len(), 2);
    let mut first = 0;
    for (primitive, group) in mesh.primitives().zip(&obj.groups) {
        let reader = primitive.reader(|_| Some(blob));
        let uvs: Vec<[f32; 2]> = reader.read_tex_coords(0).unwrap().into_f32().collect();
        let positions: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
        let indices: Vec<usize> = reader
            .read_indices()
            .unwrap()
            .into_u32()
            .map(|i| i as usize)
            .collect();
        assert_eq!(primitive.material().name(), Some(&*group.name));
        assert_eq!(indices.len(), 3 * group.triangles.len());
        for (corner, triangle) in indices.chunks(3).zip(group.triangles.clone()) {
            for k in 0..3 {
                let (a, b) = (corner[k], corner[(k + 1) % 3]);
                let apart =
                    f64::from(uvs[a][0] - uvs[b][0]).hypot(f64::from(uvs[a][1] - uvs[b][1]));
                let flat = obj.texture_triangles[triangle].map(|v| obj.texture[v as usize]);
                let rest = (flat[k] - flat[(k + 1) % 3]).norm();
                assert!((apart - rest).abs() < 1e-6, "{apart} {rest}");
                let place = obj.positions[obj.triangles[triangle][k] as usize];
                for axis in 0..3 {
                    assert!((f64::from(positions[a][axis]) - place[axis]).abs() < 1e-6);
                }
            }
        }
        assert_eq!(group.triangles.start, first);
        first = group.triangles.end;
    }
    let welded = obj.into_triangle_mesh();
    assert_eq!(welded.component_count(), 1);
    assert_eq!(welded.euler_characteristic(), 0, "a ring");
}

#[test]
fn progress_never_falls_and_every_stage_can_be_cancelled() {
    let folder = tempfile::tempdir().unwrap();
    let pattern = band(folder.path());
    let commands = make(&pattern, &folder.path().join("out"));
    let mut told: Vec<(String, f64)> = Vec::new();
    let mut watcher = |stage: &str, share: f64, _: &str| {
        told.push((stage.to_owned(), share));
        ControlFlow::Continue(())
    };
    Session::new().execute_all(&commands, &mut watcher).unwrap();
    assert!(told.windows(2).all(|pair| pair[0].1 <= pair[1].1));
    assert!(told.iter().all(|(_, share)| (0.0..=1.0).contains(share)));
    assert!(told[0].1 == 0.0 && told[told.len() - 1].1 > 0.999);

    let mut stages: Vec<&str> = told.iter().map(|(stage, _)| &**stage).collect();
    stages.dedup();
    for stage in stages {
        let dir = folder.path().join("cancelled");
        let mut session = Session::new();
        let mut watcher = |now: &str, share: f64, _: &str| match now == stage && share < 0.999 {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        };
        let error = session
            .execute_all(&make(&pattern, &dir), &mut watcher)
            .unwrap_err();
        assert!(matches!(error, SessionError::Cancelled), "{stage}: {error}");
        assert!(!error.is_bad_input());
        assert!(!dir.exists(), "{stage}");
    }
}

#[test]
fn what_was_not_made_is_not_exported() {
    let folder = tempfile::tempdir().unwrap();
    let pattern = band(folder.path());
    let dir = folder.path().join("out");
    let mut session = Session::new();
    let open = Command::open(pattern);
    let export = Command::export(&dir);
    session
        .execute_all(&[open, Command::Nest, export.clone()], &mut Silent)
        .unwrap();
    let names: Vec<String> = files(&dir).into_keys().collect();
    let expected = [
        "journal.jsonl",
        "marker.json",
        "marker.svg",
        "report.json",
        "timing.json",
    ];
    assert_eq!(names, expected);
    // An edit makes the marker stale.
    let size = Some("L".to_owned());
    session
        .execute(Command::SetSize { size }, &mut Silent)
        .unwrap();
    let error = session.execute(export, &mut Silent).unwrap_err();
    assert!(matches!(error, SessionError::Nothing { .. }), "{error}");
}

#[test]
fn the_finest_quality_swings_on_a_coarser_mesh_of_the_same_panels_first_unless_cloth_is_gathered() {
    let folder = tempfile::tempdir().unwrap();
    let path = band(folder.path());
    let levels = |quality| {
        let mut session = Session::new();
        for command in [Command::open(path.clone()), Command::SetQuality { quality }] {
            session.execute(command, &mut Silent).unwrap();
        }
        session.garment_setup().unwrap().setup.levels
    };
    assert_eq!(levels(Quality::Fit).len(), 1);
    let [first, last] = levels(Quality::Final).try_into().unwrap();
    assert_eq!(
        first.cloth.triangles,
        levels(Quality::Preview)[0].cloth.triangles
    );
    assert!(last.cloth.triangles.len() > 4 * first.cloth.triangles.len());
    assert_eq!(
        last.cloth.panel.iter().max(),
        first.cloth.panel.iter().max()
    );

    let gathered = BAND.replace(
        "\"name\": \"left\",\n",
        "\"name\": \"left\",\n\"gathered\": true,\n",
    );
    std::fs::write(&path, gathered).unwrap();
    assert_eq!(levels(Quality::Final).len(), 1);
}
