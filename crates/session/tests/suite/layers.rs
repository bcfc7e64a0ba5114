//! Several garments worn over one another, from their patterns to their files.

use crate::support::{BAND, files, lasting};
use std::path::Path;
use toile_session::{
    Command, Event, OtherGarment, Quality, Session, SessionError, Silent, open_journal,
};

/// The band, and a wider one for over it.
fn bands(folder: &Path) -> [std::path::PathBuf; 2] {
    let wide = BAND
        .replace("\"Band\"", "\"Belt\"")
        .replace("waist / 2 + 0.5cm", "waist / 2 + 2cm")
        .replace("-4]", "-3]")
        .replace("4]", "3]");
    [("band", BAND), ("belt", &wide)].map(|(name, text)| {
        let path = folder.join(format!("{name}.toile.json"));
        std::fs::write(&path, text).unwrap();
        path
    })
}

fn wear(paths: &[std::path::PathBuf; 2], layers: [u16; 2], out: &Path) -> Vec<Command> {
    vec![
        Command::open(paths[0].clone()),
        Command::SetLayers {
            layer: layers[0],
            others: vec![OtherGarment {
                path: paths[1].clone(),
                layer: layers[1],
            }],
        },
        Command::SetQuality {
            quality: Quality::Preview,
        },
        Command::Check,
        Command::Nest,
        Command::Assemble,
        Command::drape(),
        Command::export(out),
    ]
}

#[test]
fn a_belt_over_a_band_in_order_as_files_and_again_from_the_journal() {
    let folder = tempfile::tempdir().unwrap();
    let paths = bands(folder.path());
    let out = folder.path().join("out");
    let mut session = Session::new();
    session
        .execute_all(&wear(&paths, [1, 2], &out), &mut Silent)
        .unwrap();
    let made = files(&out);
    for name in ["layer-1-band.obj", "layer-2-belt.obj", "garment.glb"] {
        assert!(made.contains_key(name), "{name}");
    }
    let report: serde_json::Value = serde_json::from_slice(&made["report.json"]).unwrap();
    assert_eq!(report["components"], 2);
    assert_eq!(report["body_intersections"], 0);
    assert_eq!(report["self_intersections"], 0);
    assert_eq!(report["pieces"].as_array().unwrap().len(), 4);
    assert_eq!(report["pieces"][2]["name"], "Belt: front");
    let layers = report["layers"].as_array().unwrap();
    assert_eq!(layers.len(), 2);
    for (k, name) in ["Band", "Belt"].into_iter().enumerate() {
        assert_eq!(layers[k]["layer"], k + 1);
        assert_eq!(layers[k]["garments"][0]["name"], name);
        for count in [
            "body_intersections",
            "self_intersections",
            "outer_intersections",
            "astray",
        ] {
            assert_eq!(layers[k][count], 0, "{name} {count}");
        }
        let obj = format!("layer-{}-{}.obj", k + 1, name.to_lowercase());
        let mesh = toile_interchange::read_obj(&made[&obj])
            .unwrap()
            .into_triangle_mesh();
        assert_eq!(mesh.component_count(), 1);
        assert_eq!(layers[k]["garments"][0]["vertices"], mesh.positions.len());
    }
    let glb = gltf::Gltf::from_slice(&made["garment.glb"]).unwrap();
    let names: Vec<_> = glb
        .meshes()
        .map(|mesh| mesh.name().unwrap().to_owned())
        .collect();
    assert_eq!(names, ["Band", "Belt"]);

    let (journal, notes) = open_journal(&out.join("journal.jsonl")).unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    let again = folder.path().join("again");
    Session::replay(&journal, &again, &mut Silent).unwrap();
    assert_eq!(lasting(&out), lasting(&again));
}

#[test]
fn layers_that_cannot_be_worn_are_refused_and_nothing_changes() {
    let folder = tempfile::tempdir().unwrap();
    let paths = bands(folder.path());
    let mut session = Session::new();
    let open = Command::open(paths[0].clone());
    session.execute(open, &mut Silent).unwrap();
    let before = session.project().clone();
    let mut refused = |path: &Path, layer: u16| {
        let command = Command::SetLayers {
            layer: 1,
            others: vec![OtherGarment {
                path: path.to_owned(),
                layer,
            }],
        };
        session.execute(command, &mut Silent).unwrap_err()
    };
    let error = refused(&paths[1], 1000);
    assert!(
        matches!(error, SessionError::Number { value: 1000.0, .. }),
        "{error}"
    );
    assert!(
        refused(&folder.path().join("gone.json"), 2)
            .to_string()
            .contains("gone.json")
    );
    let other_sizes = folder.path().join("sizes.toile.json");
    std::fs::write(
        &other_sizes,
        BAND.replace("\"name\": \"L\"", "\"name\": \"XL\""),
    )
    .unwrap();
    let size = Command::SetSize {
        size: Some("L".into()),
    };
    let worn = |path: &Path| Command::SetLayers {
        layer: 1,
        others: vec![OtherGarment {
            path: path.to_owned(),
            layer: 2,
        }],
    };
    session.execute(size.clone(), &mut Silent).unwrap();
    let error = session
        .execute(worn(&other_sizes), &mut Silent)
        .unwrap_err();
    assert!(error.to_string().contains("sizes.toile.json"), "{error}");
    session.execute(Command::Undo, &mut Silent).unwrap();
    assert_eq!(session.project(), &before);

    // Worn, taken off by Undo, and worn again.
    session.execute(worn(&paths[1]), &mut Silent).unwrap();
    assert_eq!(session.can_undo(), Some("Choose layers"));
    assert_eq!(session.garment_setup().unwrap().parts.len(), 2);
    session.execute(Command::Undo, &mut Silent).unwrap();
    assert_eq!(session.garment_setup().unwrap().parts.len(), 1);
    session.execute(Command::Redo, &mut Silent).unwrap();
    assert_eq!(session.garment_setup().unwrap().parts[1].layer, 2);

    // Its file deleted, its layer still changes: it is worn as it was opened, and that is said.
    std::fs::remove_file(&paths[1]).unwrap();
    let mut deeper = worn(&paths[1]);
    if let Command::SetLayers { layer, .. } = &mut deeper {
        *layer = 0;
    }
    let events = session.execute(deeper, &mut Silent).unwrap();
    let is_told = |event: &Event| matches!(event, Event::Warned { message } if message.contains("as it was when it was opened"));
    assert!(events.iter().any(is_told), "{events:?}");
    assert_eq!(session.garment_setup().unwrap().parts.len(), 2);
}
