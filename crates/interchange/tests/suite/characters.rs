//! Character files: written and read again, written by hand, damaged.

use toile_body::{Clip, Figure, Mannequin};
use toile_interchange::{read_character, write_character};

const DOG: &str = include_str!("../../../realtime/tests/dog.character.json");

#[test]
fn a_mannequins_character_is_written_and_read_again_to_the_bit() {
    let body = Mannequin::new(&Figure::Woman.average(), Figure::Woman).unwrap();
    let [stand, walk] = [Clip::stand(body.skeleton()), Clip::walk(body.skeleton())];
    let character = body
        .character(&[("stand", &stand), ("walk", &walk)])
        .unwrap();
    let text = write_character(&character).unwrap();
    assert_eq!(read_character(&text).unwrap(), character);
}

#[test]
fn a_dog_written_by_hand_is_read() {
    let dog = read_character(DOG).unwrap();
    assert_eq!(dog.ellipsoids.len(), 9);
    assert_eq!(
        read_character(&write_character(&dog).unwrap()).unwrap(),
        dog
    );
}

#[test]
fn what_is_wrong_is_refused_with_place_and_remedy() {
    for (good, bad, place) in [
        ("\"character\"", "\"mannequin\"", "kind"),
        ("\"toile\": 1", "\"toile\": 2", "kind"),
        (
            "\"parent\": \"body\"",
            "\"parent\": \"wing\"",
            "joints[1] neck",
        ),
        (
            "\"parent\": \"body\"",
            "\"parent\": \"tail\"",
            "joints[1] neck",
        ),
        (
            "\"name\": \"tail\", \"parent\"",
            "\"name\": \"neck\", \"parent\"",
            "joints[2]",
        ),
        (
            "\"group\": \"trunk\"",
            "\"group\": \"fin\"",
            "ellipsoids[0]",
        ),
        ("\"joint\": \"neck\"", "\"joint\": \"fin\"", "ellipsoids[2]"),
        ("[0.13, 0.14, 0.19]", "[0.13, 0, 0.19]", "ellipsoids[0]"),
        ("[0.13, 0.14, 0.19]", "[0.13, 1e30, 0.19]", "ellipsoids[0]"),
        (
            "\"touches\": [\"head\"",
            "\"touches\": [\"wing\"",
            "groups[0] trunk",
        ),
        ("\"time\": 0.25", "\"time\": 0.75", "clip trot, keys[2]"),
        (
            "\"time\": 0, \"shift\"",
            "\"time\": 0.1, \"shift\"",
            "clip trot, keys[0]",
        ),
        (
            "\"neck\": [0.1, 0, 0]",
            "\"wing\": [0.1, 0, 0]",
            "clip trot, keys[1]",
        ),
        ("\"keys\": [{ \"time\": 0 }]", "\"keys\": []", "clip stand"),
        ("\"name\": \"trot\"", "\"name\": \"stand\"", "clips[1]"),
        ("\"clips\"", "\"clip\"", "line"),
    ] {
        assert!(DOG.contains(good), "{good}");
        let error = read_character(&DOG.replacen(good, bad, 1)).unwrap_err();
        assert!(error.place.starts_with(place), "{bad}: {error}");
        assert!(!error.hint.is_empty());
    }
}

#[test]
fn damaged_files_are_refused_without_a_panic() {
    for k in 0..300 {
        let cut = DOG.len() * k / 300;
        assert!(read_character(&DOG[..cut]).is_err());
        let mut bytes = DOG.as_bytes().to_vec();
        bytes[cut] = bytes[cut].wrapping_add(1 + (k % 7) as u8) & 0x7f;
        // What still reads is a character that can be moved.
        if let Ok(character) = read_character(&String::from_utf8(bytes).unwrap()) {
            assert!(toile_realtime::Ellipsoids::new(&character).is_ok());
        }
    }
}
