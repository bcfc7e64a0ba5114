//! Markers in journals: those of before are read and written as they were, and what is given stays given.

use toile_pattern::{
    ClothSettings, DEFAULT_GAP, DEFAULT_SELVEDGE, Entity, FabricId, LayingRule, Marker, MarkerId,
    OrderedSize, PanelId, PiecePlacement, PieceRule, Roll, RuledPieces, Spread, Turn,
};

/// A marker as journals of before have it: nothing was left open.
const BEFORE: &str = r#"{"marker":{"id":66,"name":"winter","cloth":{"fabric":5,"keeps_fabric":false,"width":null,"length":3.0,"selvedge":0.01,"end_margin":0.0,"gap":0.002,"nap":null,"tilt":0.0,"spread":"face-to-face","plies":2,"price_per_metre":null,"currency":"","print":null,"flaws":[]},"order":[{"size":0,"quantity":1}],"placements":[{"piece":{"panel":8,"copy":1,"size":0,"garment":1},"at":[0.1,0.2],"turn":3.141592653589793,"flipped":true,"locked":true}]}}"#;

fn read(text: &str) -> Marker {
    match serde_json::from_str(text).unwrap() {
        Entity::Marker(marker) => (*marker).clone(),
        other => panic!("{other:?}"),
    }
}

fn written(marker: &Marker) -> String {
    serde_json::to_string(&Entity::Marker(marker.clone().into())).unwrap()
}

#[test]
fn markers_of_before_are_read_and_written_as_they_were() {
    let marker = read(BEFORE);
    assert_eq!(marker.fabric, FabricId(5));
    let cloth = ClothSettings {
        length: Some(3.0),
        spread: Some(Spread::FaceToFace),
        ..ClothSettings::default()
    };
    assert_eq!(marker.cloth, cloth, "what is as by default was not given");
    assert_eq!(written(&marker), BEFORE);
    // Before a marker could keep its fabric.
    let older = BEFORE.replace(r#""keeps_fabric":false,"#, "");
    assert_eq!(read(&older), marker);
}

#[test]
fn what_is_given_stays_given_though_it_is_as_by_default() {
    let given = Marker {
        id: MarkerId(7),
        name: "given".into(),
        fabric: FabricId(5),
        cloth: ClothSettings {
            selvedge: Some(DEFAULT_SELVEDGE),
            end_margin: Some(0.0),
            gap: Some(DEFAULT_GAP),
            tilt: Some(0.0),
            spread: Some(Spread::Open),
            plies: Some(1),
            currency: Some(String::new()),
            flaws: Some(Vec::new()),
            rolls: Some(vec![
                Roll::default(),
                Roll {
                    name: Some("bolt".into()),
                    flaws: Some(Vec::new()),
                    ..Roll::default()
                },
            ]),
            ..ClothSettings::default()
        },
        rules: vec![
            PieceRule {
                pieces: RuledPieces::Copy(PanelId(3), 1),
                rule: LayingRule {
                    block: Some(0.01),
                    turns: Some(vec![Turn(0.0)]),
                    ..LayingRule::default()
                },
                ..PieceRule::default()
            },
            PieceRule::default(),
        ],
        order: vec![OrderedSize::default()],
        placements: vec![PiecePlacement {
            roll: 1,
            ..PiecePlacement::default()
        }],
        ..Marker::default()
    };
    let again = read(&written(&given));
    assert_eq!(again, given);
    assert_eq!(written(&again), written(&given));
    // Each by itself, beside others that are left open.
    let fields: [fn(&mut ClothSettings, &ClothSettings); 8] = [
        |own, all| own.selvedge = all.selvedge,
        |own, all| own.end_margin = all.end_margin,
        |own, all| own.gap = all.gap,
        |own, all| own.tilt = all.tilt,
        |own, all| own.spread = all.spread,
        |own, all| own.plies = all.plies,
        |own, all| own.currency.clone_from(&all.currency),
        |own, all| own.flaws.clone_from(&all.flaws),
    ];
    for give in fields {
        let mut one = Marker {
            cloth: ClothSettings::default(),
            ..given.clone()
        };
        give(&mut one.cloth, &given.cloth);
        assert_eq!(read(&written(&one)), one);
    }
}
