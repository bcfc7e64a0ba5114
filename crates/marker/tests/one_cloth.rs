//! One cloth said by arguments, by settings and by a marker of the document: the same marker, to the byte.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;
use toile_geometry::Length;
use toile_interchange::{read_marker_settings, read_pattern, write_marker_json};
use toile_marker::{
    DocumentMarker, FinishedMarker, Garments, GivenFlaw, MarkerPieces, NestOptions, SearchWatcher,
    Start, lay,
};
use toile_nesting::{Budget, Search};
use toile_pattern::{
    ClothSettings, Draft, Edit, Entity, Evaluation, Flaw, GarmentCloth, LayingRule, MarkRef,
    Marker, MatchedMarks, NapRule, OrderedSize, Pattern, PieceRule, Print, Roll, RuledPieces,
    SizeId, Spread, Turn,
};

/// Evaluations of each search.
const EVALUATIONS: u64 = 3_000;

/// A sequence of chance: SplitMix64.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A whole number from one below another.
    fn from(&mut self, low: u64, high: u64) -> u64 {
        low + self.next() % (high - low)
    }

    fn chance(&mut self, percent: u64) -> bool {
        self.next() % 100 < percent
    }
}

/// A length of whole millimetres as settings say it.
fn text(millimetres: u64) -> String {
    format!("\"{millimetres}mm\"")
}

/// The same (m).
fn metres(millimetres: u64) -> f64 {
    let length: Length = format!("{millimetres}mm").parse().unwrap();
    length.as_metres()
}

fn texts(of: [u64; 2]) -> String {
    format!("[{}, {}]", text(of[0]), text(of[1]))
}

fn flaw(dice: &mut Dice, is_plain: bool) -> (String, Flaw) {
    let at = [dice.from(300, 1200), dice.from(200, 900)];
    let size = [dice.from(10, 60), dice.from(10, 60)];
    let clearance = if is_plain { 0 } else { dice.from(0, 9) };
    let words = format!(
        "{{ \"at\": {}, \"size\": {}, \"clearance\": {} }}",
        texts(at),
        texts(size),
        text(clearance)
    );
    let flaw = Flaw {
        at: at.map(metres),
        size: size.map(metres),
        clearance: metres(clearance),
    };
    (words, flaw)
}

/// A cloth as settings say it, field by field, and as a document does.
fn cloth(dice: &mut Dice, is_plain: bool) -> (Vec<String>, ClothSettings) {
    let mut said = Vec::new();
    let mut cloth = ClothSettings::default();
    let mut length = |dice: &mut Dice, name: &str, (low, high): (u64, u64)| {
        dice.chance(70).then(|| {
            let number = dice.from(low, high);
            said.push(format!("\"{name}\": {}", text(number)));
            metres(number)
        })
    };
    cloth.width = length(dice, "width", (1300, 1700));
    cloth.selvedge = length(dice, "selvedge", (0, 30));
    cloth.end_margin = length(dice, "end_margin", (0, 40));
    cloth.gap = length(dice, "gap", (0, 10));
    if dice.chance(60) {
        let naps = [
            (NapRule::None, "none"),
            (NapRule::OneWay, "one-way"),
            (NapRule::PerGarment, "per-garment"),
        ];
        let (nap, word) = naps[dice.from(0, 3) as usize];
        said.push(format!("\"nap\": \"{word}\""));
        cloth.nap = Some(nap);
    }
    if dice.chance(50) {
        let spreads = [
            (Spread::Open, "open"),
            (Spread::Folded, "folded"),
            (Spread::FaceToFace, "face-to-face"),
        ];
        let (spread, word) = spreads[dice.from(0, 3) as usize];
        said.push(format!("\"spread\": \"{word}\""));
        cloth.spread = Some(spread);
    }
    if dice.chance(50) {
        let plies = 2 * dice.from(1, 3);
        said.push(format!("\"plies\": {plies}"));
        cloth.plies = Some(plies as u32);
    }
    if dice.chance(50) {
        let repeat = [dice.from(40, 80), dice.from(0, 2) * 50];
        let origin = if is_plain {
            [0; 2]
        } else {
            [dice.from(0, 9), 3]
        };
        let words = (texts(repeat), texts(origin));
        said.push(format!(
            "\"print\": {{ \"repeat\": {}, \"origin\": {} }}",
            words.0, words.1
        ));
        cloth.print = Some(Print {
            repeat: repeat.map(metres),
            origin: origin.map(metres),
        });
    }
    let rolled = dice.chance(50);
    if dice.chance(50) && !(rolled && is_plain) {
        let flaws = (0..dice.from(0, 3)).map(|_| flaw(dice, is_plain));
        let (words, flaws): (Vec<String>, Vec<Flaw>) = flaws.unzip();
        said.push(format!("\"flaws\": [{}]", words.join(", ")));
        cloth.flaws = Some(flaws);
    }
    if rolled {
        let mut rolls = Vec::new();
        let mut words = Vec::new();
        for low in [4000, 90_000] {
            let number = dice.from(low, low + 2000);
            let mut fields = vec![format!("\"length\": {}", text(number))];
            let mut roll = Roll {
                length: Some(metres(number)),
                ..Roll::default()
            };
            if dice.chance(50) {
                let width = dice.from(1350, 1600);
                fields.push(format!("\"width\": {}", text(width)));
                roll.width = Some(metres(width));
            }
            if !is_plain && dice.chance(50) {
                let (said, flaw) = flaw(dice, false);
                fields.push(format!("\"flaws\": [{said}]"));
                fields.push(format!("\"name\": \"of {low}\""));
                roll.flaws = Some(vec![flaw]);
                roll.name = Some(format!("of {low}"));
            }
            words.push(format!("{{ {} }}", fields.join(", ")));
            rolls.push(roll);
        }
        said.push(format!("\"rolls\": [{}]", words.join(", ")));
        cloth.rolls = Some(rolls);
    }
    (said, cloth)
}

/// Rules by name as settings say them, and as a document does.
fn rules(dice: &mut Dice, (pattern, draft): (&Pattern, &Draft)) -> (Vec<String>, Vec<PieceRule>) {
    let mut names = vec![("*".to_owned(), RuledPieces::All)];
    for panel in &pattern.panels {
        names.push((panel.name.clone(), RuledPieces::Panel(panel.id)));
    }
    for piece in draft.pieces.iter().filter(|piece| piece.id.copy == 1) {
        let pieces = RuledPieces::Copy(piece.id.panel, 1);
        names.push((piece.name.clone(), pieces));
    }
    let mut said = Vec::new();
    let mut rules = Vec::new();
    for (name, pieces) in names {
        let mut fields = Vec::new();
        let mut rule = LayingRule::default();
        if dice.chance(30) {
            let (gap, block) = (dice.from(0, 12), dice.from(0, 12));
            fields.push(format!(
                "\"gap\": {}, \"block\": {}",
                text(gap),
                text(block)
            ));
            (rule.gap, rule.block) = (Some(metres(gap)), Some(metres(block)));
        }
        if dice.chance(30) {
            let tilt = dice.from(0, 4);
            fields.push(format!("\"tilt\": {tilt}"));
            rule.tilt = Some((tilt as f64).to_radians());
        }
        if dice.chance(30) {
            let turns: &[f64] = [&[0.0][..], &[0.0, 180.0], &[180.0]][dice.from(0, 3) as usize];
            fields.push(format!("\"turns\": {turns:?}"));
            rule.turns = Some(turns.iter().map(|turn| Turn(turn.to_radians())).collect());
        }
        let flags = [
            ("turn_over", &mut rule.turn_over),
            ("on_fold", &mut rule.on_fold),
            ("over_flaws", &mut rule.over_flaws),
            ("on_print", &mut rule.on_print),
        ];
        for (name, flag) in flags {
            if dice.chance(15) {
                let is_on = dice.chance(50);
                fields.push(format!("\"{name}\": {is_on}"));
                *flag = Some(is_on);
            }
        }
        if !fields.is_empty() {
            said.push(format!("{name:?}: {{ {} }}", fields.join(", ")));
            rules.push(PieceRule {
                pieces,
                rule,
                ..PieceRule::default()
            });
        }
    }
    (said, rules)
}

/// The first two panels' notches of one name.
fn marks(pattern: &Pattern) -> (String, MatchedMarks) {
    let [one, other] = [0, 1].map(|k| &pattern.panels[k]);
    let shared = one.notches.iter().find_map(|notch| {
        let same = other.notches.iter().find(|own| own.name == notch.name);
        Some((notch, same?))
    });
    let (first, second) = shared.unwrap();
    let mark = |(panel, notch): (&toile_pattern::Panel, &toile_pattern::Notch)| MarkRef {
        panel: panel.id,
        notch: notch.id,
    };
    let said = [(one, first), (other, second)];
    let names = said.map(|(panel, notch)| format!("\"{}.{}\"", panel.name, notch.name));
    let matched = said.map(|(panel, notch)| mark((&**panel, notch)));
    (names.join(", "), MatchedMarks(matched.into()))
}

type Texts = Result<Vec<String>, String>;

fn written(finished: &[FinishedMarker]) -> Vec<String> {
    let text = |finished: &FinishedMarker| write_marker_json(&finished.file("one")).unwrap();
    finished.iter().map(text).collect()
}

fn watched<T>(work: impl FnOnce(&mut SearchWatcher<'_>) -> T) -> T {
    work(&mut SearchWatcher {
        report: &mut |_| true,
        stop: Arc::default(),
    })
}

/// A pattern drafted to its middle size.
struct Drafted {
    pattern: Pattern,
    draft: Arc<Draft>,
    size: SizeId,
}

impl Drafted {
    fn of(text: &str) -> Self {
        let (pattern, _) = read_pattern(text).unwrap();
        let size = pattern.size_named("M").unwrap();
        let (id, (draft, _)) = (size.id, Evaluation::new(&pattern, size).draft());
        Self {
            size: id,
            draft: Arc::new(draft),
            pattern,
        }
    }

    fn laid(&self, (options, count, seed): (NestOptions, u32, u64)) -> Texts {
        let garments = [Garments {
            pattern: &self.pattern,
            draft: &self.draft,
            count,
            label: None,
        }];
        let options = NestOptions {
            budget: Budget::Evaluations(EVALUATIONS),
            seed,
            ..options
        };
        let finished = watched(|follow| lay(&garments, &options, follow));
        Ok(written(&finished.map_err(|error| error.to_string())?))
    }

    fn of_document(&self, (marker, quantity, seed): (Marker, u32, u64)) -> Texts {
        let mut marker = Marker {
            name: "one".into(),
            fabric: self.pattern.fabrics[0].id,
            order: vec![OrderedSize {
                size: Some(self.size),
                quantity,
            }],
            ..marker
        };
        assert_eq!(marker.fault(), None);
        let drafts = [(Some(self.size), self.draft.clone())];
        let of = (&self.pattern, &GarmentCloth::default());
        let pieces = MarkerPieces::new(of, &marker, (&drafts, ""));
        let pieces = Arc::new(pieces.map_err(|error| error.to_string())?);
        let search = Search {
            budget: Budget::Evaluations(EVALUATIONS),
            seed,
            ..Search::default()
        };
        let waits = DocumentMarker::new(Arc::new(marker.clone()), pieces.clone());
        let found = watched(|follow| waits.search((Start::Anew, search), follow));
        marker.placements = found.map_err(|error| error.to_string())?.placements;
        let laid = DocumentMarker::new(Arc::new(marker), pieces);
        let finished = laid.finished_rolls();
        for one in &finished {
            assert!(one.verdict.is_sound(), "{:?}", one.faults());
        }
        Ok(written(&finished))
    }
}

#[test]
fn arguments_settings_and_the_document_lay_one_cloth_alike() {
    let patterns = [
        include_str!("../../../patterns/trousers.toile.json"),
        include_str!("../../../patterns/t-shirt.toile.json"),
    ];
    let patterns = patterns.map(Drafted::of);
    let (mut laid, mut on_rolls) = (0, 0);
    for seed in 0..20 {
        let dice = &mut Dice(seed);
        let own = &patterns[seed as usize % 2];
        let is_plain = seed % 4 < 2;
        let (said, cloth) = cloth(dice, is_plain);
        let count = dice.from(1, 3) as u32;
        let (mut pieces, mut rules) = rules(dice, (&own.pattern, &own.draft));
        let (names, marks) = marks(&own.pattern);
        let matches = !is_plain && dice.chance(50);
        if is_plain {
            (pieces, rules) = (Vec::new(), Vec::new());
        }
        let settings = format!(
            "{{ \"toile\": 1, \"kind\": \"marker-settings\", \"fabrics\": {{ \"*\": {{ {} }} }},\
             \"pieces\": {{ {} }}, \"match\": [{}] }}",
            said.join(", "),
            pieces.join(", "),
            if matches {
                format!("[{names}]")
            } else {
                String::new()
            }
        );
        let by_settings = NestOptions {
            settings: read_marker_settings(&settings).unwrap(),
            ..NestOptions::default()
        };
        let by_settings = own.laid((by_settings, count, seed));
        let marker = Marker {
            cloth: cloth.clone(),
            rules,
            matched: if matches { vec![marks] } else { Vec::new() },
            ..Marker::default()
        };
        let by_document = own.of_document((marker, count, seed));
        assert_eq!(by_settings, by_document, "seed {seed}: {settings}");
        if is_plain {
            let given = |flaw: &Flaw| {
                let ([x, y], [length, width]) = (flaw.at, flaw.size);
                GivenFlaw::at([x, y, length, width])
            };
            let by_arguments = NestOptions {
                flaws: cloth.flaws.iter().flatten().map(given).collect(),
                cloth: ClothSettings {
                    flaws: None,
                    ..cloth
                },
                ..NestOptions::default()
            };
            let by_arguments = own.laid((by_arguments, count, seed));
            assert_eq!(by_arguments, by_settings, "seed {seed}: {settings}");
        }
        if let Ok(texts) = &by_settings {
            laid += 1;
            on_rolls += usize::from(texts.len() > 1);
        }
    }
    assert!(
        laid >= 14 && on_rolls >= 2,
        "{laid} laid, {on_rolls} on rolls"
    );
}

#[test]
fn a_rule_for_a_panel_that_is_gone_is_told_and_all_else_is_laid() {
    let mut own = Drafted::of(include_str!("../../../patterns/t-shirt.toile.json"));
    let panel = |own: &Drafted, name: &str| own.pattern.panel_named(name).unwrap().clone();
    let (front, sleeve) = (panel(&own, "front"), panel(&own, "sleeve"));
    let mark = |panel: &toile_pattern::Panel| MarkRef {
        panel: panel.id,
        notch: panel.notches[0].id,
    };
    let ruled = |pieces, rule| PieceRule {
        pieces,
        rule,
        ..PieceRule::default()
    };
    let blocked = LayingRule {
        block: Some(0.01),
        ..LayingRule::default()
    };
    let marker = Marker {
        id: own.pattern.ids.take(),
        name: "marker".to_owned(),
        rules: vec![
            ruled(RuledPieces::Copy(sleeve.id, 1), blocked.clone()),
            ruled(RuledPieces::Panel(front.id), blocked),
        ],
        matched: vec![MatchedMarks(vec![mark(&front), mark(&sleeve)])],
        fabric: own.pattern.fabrics[0].id,
        ..Marker::default()
    };
    let told = |own: &Drafted| {
        let evaluation = Evaluation::new(&own.pattern, &own.pattern.sizes[0]);
        let of_marker = |found: &toile_pattern::Diagnostic| {
            found.place == toile_pattern::Place::Marker(marker.id)
        };
        let found = evaluation.diagnostics().to_vec();
        let own = found.into_iter().filter(of_marker);
        own.map(|found| found.message).collect::<Vec<_>>()
    };
    let put = Edit::Put(Entity::Marker(Arc::new(marker.clone())));
    own.pattern.apply(&[put]).unwrap();
    assert_eq!(told(&own), [""; 0]);
    let gone = Edit::Remove(sleeve.id.into());
    own.pattern.apply(&[gone]).unwrap();
    let words = told(&own);
    assert_eq!(words.len(), 2, "{words:?}");
    assert!(
        words[0].contains("a rule of the marker names it"),
        "{words:?}"
    );
    assert!(
        words[1].contains("of the marks that match 1 are gone"),
        "{words:?}"
    );
    let size = own.pattern.size_named("M").unwrap().clone();
    own.draft = Arc::new(Evaluation::new(&own.pattern, &size).draft().0);
    let texts = own.of_document((marker, 1, 1)).unwrap();
    let (laid, waiting) = (&texts[0], texts[0].contains("\"unplaced\": []"));
    assert!(
        laid.contains("\"front\"") && laid.contains("\"back\""),
        "{laid}"
    );
    assert!(waiting && !laid.contains("\"sleeve\""), "{laid}");
}
