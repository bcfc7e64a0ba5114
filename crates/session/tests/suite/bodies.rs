//! Bodies of one's own: mannequin files worn, their primitives edited with undo.

use proptest::prelude::*;
use std::path::Path;
use toile_body::{Blend, Joint, PrimitiveEdit};
use toile_session::{
    BodyChoice, Command, Figure, SAMPLE, Session, SessionError, Silent, edit_body, open_body_edits,
    proportions_named, proportions_of_heads, read_journal,
};

fn run(session: &mut Session, command: Command) -> Result<(), SessionError> {
    session.execute(command, &mut Silent).map(|_| ())
}

fn edit(edit: PrimitiveEdit) -> Command {
    Command::EditBody {
        edits: vec![edit],
        label: "Edit primitive".into(),
    }
}

fn weigh(primitive: usize, weight: f64) -> Command {
    edit(PrimitiveEdit::Weigh { primitive, weight })
}

/// The body as the file it is saved as.
fn saved(session: &mut Session, folder: &Path) -> String {
    let path = folder.join("body.json");
    run(session, Command::SaveBody { path: path.clone() }).unwrap();
    std::fs::read_to_string(path).unwrap()
}

#[test]
fn a_mannequin_file_is_worn_edited_and_undone() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = Session::new();
    let choose = Command::SetBody {
        figure: Some(Figure::Man),
        measurements: None,
    };
    run(&mut session, choose).unwrap();
    let grown = saved(&mut session, folder.path());
    let own = folder.path().join("own.json");
    std::fs::write(&own, &grown).unwrap();
    let wear = Command::SetBody {
        figure: None,
        measurements: Some(own.clone()),
    };
    run(&mut session, wear).unwrap();
    assert_eq!(session.project().figure(), Figure::Man);
    assert!(session.project().body.words().contains("own.json"));
    let waist = |s: &Session| s.project().body_measurements().get("waist").unwrap();
    let before = waist(&session);
    assert_eq!(saved(&mut session, folder.path()), grown);
    // Several edits are one step; the body then stands by no file.
    let scale = |step: f64| PrimitiveEdit::Weigh {
        primitive: 2,
        weight: 1.0 + 0.05 * step,
    };
    let command = Command::EditBody {
        edits: [0.0, 1.0, 2.0].map(scale).to_vec(),
        label: "Weigh primitive".into(),
    };
    run(&mut session, command).unwrap();
    assert!(matches!(
        &session.project().body,
        BodyChoice::Shaped { path: None, .. }
    ));
    assert_ne!(saved(&mut session, folder.path()), grown);
    assert_eq!(session.can_undo(), Some("Weigh primitive"));
    run(&mut session, Command::Undo).unwrap();
    assert_eq!(saved(&mut session, folder.path()), grown);
    assert_eq!(waist(&session), before);
    // A body whose edits leave a hole, or that are none, changes nothing.
    let far = PrimitiveEdit::Move {
        primitive: 9999,
        centre: [0.0; 3],
    };
    let project = session.project().clone();
    assert!(run(&mut session, edit(far)).unwrap_err().is_bad_input());
    assert_eq!(*session.project(), project);
}

#[test]
fn the_garment_is_made_on_the_edited_body() {
    let mut session = Session::new();
    run(&mut session, Command::open(SAMPLE)).unwrap();
    run(&mut session, weigh(2, 1.3)).unwrap();
    let project = session.project().clone();
    assert!(matches!(project.body, BodyChoice::Shaped { .. }));
    assert!(project.body_measurements().get("height").is_some());
    // What is written in the journal makes the same body again.
    let lines = toile_session::journal_lines(&session.journal()).unwrap();
    let mut again = Session::new();
    for command in read_journal(&lines).unwrap() {
        run(&mut again, command).unwrap();
    }
    assert_eq!(again.project().body, project.body);
}

#[test]
fn boxes_and_edits_are_found_by_name_and_file() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(proportions_named("loomis-5").unwrap().heads, 6.0);
    let lost = proportions_named("giant").unwrap_err().to_string();
    assert!(lost.contains("draftsman-8"), "{lost}");
    let file = folder.path().join("own.json");
    let table = r#"[{"name": "short", "heads": 6.5}, {"name": "tall", "heads": 8.2}]"#;
    std::fs::write(&file, table).unwrap();
    let named = |name: &str| proportions_named(&format!("{}{name}", file.display()));
    assert_eq!(named("").unwrap().heads, 6.5);
    assert_eq!(named(":tall").unwrap().heads, 8.2);
    assert!(named(":none").is_err());
    let between = proportions_of_heads(6.1);
    assert!(
        between
            .crotch
            .is_some_and(|crotch| crotch > 2.53 && crotch < 2.76)
    );
    std::fs::write(
        &file,
        r#"[{"edit": "weigh", "primitive": 0, "weight": 1.2}]"#,
    )
    .unwrap();
    let edits = open_body_edits(&file).unwrap();
    let made = edit_body(None, Session::new().project(), &edits).unwrap();
    assert_eq!(made.primitives[0].weight, 1.2);
    std::fs::write(&file, r#"[{"edit": "weight", "primitive": 0}]"#).unwrap();
    assert!(
        open_body_edits(&file)
            .unwrap_err()
            .to_string()
            .contains("weight")
    );
}

fn any_edit() -> impl Strategy<Value = PrimitiveEdit> {
    let which = 0..20_usize;
    prop_oneof![
        (which.clone(), 0.9..1.2_f64)
            .prop_map(|(primitive, weight)| PrimitiveEdit::Weigh { primitive, weight }),
        prop::collection::vec(which.clone(), 2..4)
            .prop_map(|primitives| PrimitiveEdit::Join { primitives }),
        which.clone().prop_map(|primitive| PrimitiveEdit::Attach {
            primitive,
            joint: Joint::Vl5
        }),
        which
            .clone()
            .prop_map(|primitive| PrimitiveEdit::Delete { primitive }),
        which.prop_map(|primitive| PrimitiveEdit::Blend {
            primitive,
            blend: Blend::Unblendable
        }),
    ]
}

#[test]
fn a_body_whose_landmarks_are_gone_is_refused() {
    let mut session = Session::new();
    let delete = |primitive| edit(PrimitiveEdit::Delete { primitive });
    let mut refused = 0;
    for primitive in [0, 18] {
        let before = session.project().clone();
        if run(&mut session, delete(primitive)).is_err() {
            assert_eq!(*session.project(), before);
            refused += 1;
        }
    }
    assert_eq!(refused, 1);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]
    /// Whatever is done, undo gives back the very bytes of every step, and redo those after.
    #[test]
    fn undo_restores_the_bytes(edits in prop::collection::vec(any_edit(), 1..6)) {
        let folder = tempfile::tempdir().unwrap();
        let mut session = Session::new();
        let mut steps = vec![saved(&mut session, folder.path())];
        for change in edits {
            let before = session.project().clone();
            // Refused or without effect, it is no step.
            if run(&mut session, edit(change)).is_ok() && *session.project() != before {
                steps.push(saved(&mut session, folder.path()));
            }
        }
        for step in steps.iter().rev().skip(1) {
            run(&mut session, Command::Undo).unwrap();
            prop_assert_eq!(&saved(&mut session, folder.path()), step);
        }
        prop_assert!(session.can_undo().is_none());
        for step in &steps[1..] {
            run(&mut session, Command::Redo).unwrap();
            prop_assert_eq!(&saved(&mut session, folder.path()), step);
        }
    }
}

#[test]
fn every_edit_of_a_mannequin_is_documented_as_it_is_read() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/FORMATS.md");
    let text = std::fs::read_to_string(path).unwrap();
    let section = text.split("## Edits of a mannequin").nth(1).unwrap();
    let section = section.split("\n## ").next().unwrap();
    let lines = section.lines().filter(|line| line.starts_with("{\"edit\""));
    let mut named: Vec<String> = Vec::new();
    for line in lines {
        let edit: PrimitiveEdit = serde_json::from_str(line).expect(line);
        let written = serde_json::to_value(&edit).unwrap();
        named.push(written["edit"].as_str().unwrap().to_owned());
    }
    // The refusal of an edit that is not known lists them all.
    let error = serde_json::from_str::<PrimitiveEdit>(r#"{"edit": "none"}"#).unwrap_err();
    let listed = error.to_string();
    let known: Vec<&str> = listed.split('`').skip(3).step_by(2).collect();
    assert!(known.len() >= 13, "{listed}");
    assert_eq!(named, known);
}
