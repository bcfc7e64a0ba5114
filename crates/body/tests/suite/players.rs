//! The player by random commands, the way into a clip, and limbs that are kept apart.

use std::sync::LazyLock;
use toile_body::{
    Clip, FASTEST_TURN, Figure, Joint, Mannequin, PlayCommand, Playback, Player, Pose,
};
use toile_geometry::SurfaceTree;
use toile_measure::Measurements;

static WOMAN: LazyLock<Mannequin> =
    LazyLock::new(|| Mannequin::new(&Measurements::adult_woman(), Figure::Woman).unwrap());

const STEP: f64 = 1.0 / 120.0;

fn player() -> Player {
    let skeleton = WOMAN.skeleton();
    let clips = [Clip::stand, Clip::astride, Clip::walk, Clip::run].map(|clip| clip(skeleton));
    Player::new(clips.to_vec(), 0).unwrap()
}

/// The random numbers of a seed, below a bound.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, bound: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 16) % bound
    }
}

/// A thousand commands with the step before which each is given.
fn commands() -> Vec<(usize, PlayCommand)> {
    let mut numbers = Numbers(0x51ed_270b_9f61_2c45);
    let mut step = 0;
    let new = |_| {
        step += numbers.below(90) as usize;
        let command = match numbers.below(5) {
            0 => PlayCommand::Start,
            1 if numbers.below(3) == 0 => PlayCommand::Stop,
            2 => PlayCommand::Rate(numbers.below(201) as f64 / 100.0),
            _ => PlayCommand::Change {
                clip: numbers.below(4) as usize,
                fade: numbers.below(80) as f64 / 100.0,
            },
        };
        (step, command)
    };
    (0..1000).map(new).collect()
}

/// Plays from a step to another; what is shown after each.
fn play(player: &mut Player, steps: std::ops::Range<usize>) -> Vec<(Pose, Playback)> {
    let commands = commands();
    let mut next = commands.partition_point(|(at, _)| *at < steps.start);
    steps
        .map(|step| {
            while let Some((_, command)) = commands.get(next).filter(|(at, _)| *at == step) {
                player.tell(*command).unwrap();
                next += 1;
            }
            player.advance(STEP);
            (player.pose(), player.playback().clone())
        })
        .collect()
}

fn turn(a: &Pose, b: &Pose) -> f64 {
    let turns = Joint::ALL.map(|joint| a.rotation(joint).angle_to(&b.rotation(joint)));
    turns.into_iter().fold(0.0, f64::max)
}

#[test]
fn a_thousand_commands_make_no_joint_turn_too_fast_and_are_replayed_to_the_bit() {
    let end = commands().last().unwrap().0 + 200;
    let mut first = player();
    let begun = first.pose();
    let shown = play(&mut first, 0..end);
    let mut before = &begun;
    let (mut fastest, mut changes, mut farthest) = (0.0_f64, 0, 0.0_f64);
    let mut gone = toile_geometry::Vec3::zeros();
    for (pose, playback) in &shown {
        fastest = fastest.max(turn(before, pose) / STEP);
        let way = (playback.travelled() - gone).norm() / STEP;
        farthest = farthest.max(way);
        gone = playback.travelled();
        changes += usize::from(turn(before, pose) > 0.0);
        before = pose;
    }
    println!("fastest joint {fastest:.2} rad/s, root {farthest:.2} leg lengths a second");
    assert!(fastest <= FASTEST_TURN * (1.0 + 1e-9), "{fastest}");
    assert!(fastest > 0.9 * FASTEST_TURN && changes > end / 2);
    assert!(farthest < 2.0 * 3.1, "{farthest}");
    // From its inputs, and from where it was saved in the middle of a fade.
    assert_eq!(play(&mut player(), 0..end), shown);
    let in_fade = |k: &usize| {
        let text = serde_json::to_string(&shown[*k].1).unwrap();
        !text.contains("\"fade\":null")
    };
    let saved_at = (end / 2..end).find(in_fade).unwrap();
    let text = serde_json::to_string(&shown[saved_at].1).unwrap();
    let playback: Playback = serde_json::from_str(&text).unwrap();
    let skeleton = WOMAN.skeleton();
    let clips = [Clip::stand, Clip::astride, Clip::walk, Clip::run].map(|clip| clip(skeleton));
    let mut resumed = Player::resumed(clips.to_vec(), playback).unwrap();
    assert_eq!(play(&mut resumed, saved_at + 1..end), shown[saved_at + 1..]);
}

#[test]
fn a_player_that_is_told_to_play_what_is_not_there_says_so_and_goes_on_as_before() {
    let mut player = player();
    player.tell(PlayCommand::Start).unwrap();
    let before = player.clone();
    for wrong in [
        PlayCommand::Change { clip: 4, fade: 0.3 },
        PlayCommand::Change {
            clip: 1,
            fade: f64::NAN,
        },
        PlayCommand::Change {
            clip: 1,
            fade: -1.0,
        },
        PlayCommand::Rate(2.1),
        PlayCommand::Rate(f64::NAN),
    ] {
        let said = player.tell(wrong).unwrap_err().to_string();
        assert!(
            said.contains("clip 4 is not there: there are 4") || said.contains("give 0 to"),
            "{said}"
        );
        assert_eq!(player, before);
    }
    assert!(Player::new(Vec::new(), 0).is_err());
}

#[test]
fn a_walk_goes_as_far_as_its_strides_and_a_stop_ends_it() {
    let mut player = player();
    player
        .tell(PlayCommand::Change { clip: 2, fade: 0.3 })
        .unwrap();
    player.tell(PlayCommand::Start).unwrap();
    for _ in 0..1200 {
        player.advance(STEP);
    }
    let walk = Clip::walk(WOMAN.skeleton());
    let way = player.playback().travelled().z;
    // Ten seconds but for the fade and the start of the clock.
    let whole = walk.advance.z * 10.0 / walk.duration();
    assert!(way < whole && way > 0.95 * whole, "{way} {whole}");
    player.tell(PlayCommand::Stop).unwrap();
    (0..120).for_each(|_| player.advance(STEP));
    let pose = player.pose();
    player.advance(STEP);
    assert_eq!((player.pose(), player.playback().rate()), (pose, 0.0));
}

#[test]
fn the_way_into_a_clip_begins_and_ends_at_rest_and_is_slow() {
    let skeleton = WOMAN.skeleton();
    for to in [
        Clip::stand(skeleton),
        Clip::walk(skeleton),
        Clip::run(skeleton),
    ] {
        let way = Clip::lead_in(&WOMAN, &Pose::rest(), &to.poses[0]);
        assert_eq!(
            (&way.poses[0], way.poses.last()),
            (&Pose::rest(), to.poses.first())
        );
        let rate = |k: usize| turn(&way.poses[k], &way.poses[k + 1]) / way.step;
        let last = way.poses.len() - 2;
        assert!(
            rate(0) < 0.01 && rate(last) < 0.01,
            "{} {}",
            rate(0),
            rate(last)
        );
        assert!((0.4..2.5).contains(&way.duration()), "{}", way.duration());
    }
    // From a pose to itself it is as short as any.
    let still = Clip::lead_in(&WOMAN, &Pose::rest(), &Pose::rest());
    assert!((still.duration() - 0.4).abs() < 1e-9);
}

fn crossings(body: &Mannequin, clip: &Clip) -> Vec<usize> {
    let at = |k: usize| {
        let skin = body.posed_skin(&clip.pose_for(body.skeleton(), k as f64 * clip.step));
        SurfaceTree::new(skin).self_intersections().len()
    };
    (0..clip.poses.len()).step_by(2).map(at).collect()
}

#[test]
fn own_gaits_cross_nothing_once_they_are_cleared_and_what_is_clear_stays() {
    let people = [
        (Measurements::adult_woman(), Figure::Woman),
        (Measurements::adult_man(), Figure::Man),
    ];
    for (table, figure) in people {
        let body = Mannequin::new(&table, figure).unwrap();
        for (name, clip) in [
            ("walk", Clip::walk(body.skeleton())),
            ("run", Clip::run(body.skeleton())),
            ("stand", Clip::stand(body.skeleton())),
        ] {
            let cleared = clip.cleared(&body, 0.012);
            let [before, after] = [&clip, &cleared.clip].map(|clip| crossings(&body, clip));
            let [shoulder, hip] = cleared.largest_turn.map(f64::to_degrees);
            println!(
                "{figure:?} {name}: pairs {} -> {}, shoulder {shoulder:.1}, hip {hip:.1} degrees, {} unclear",
                before.iter().sum::<usize>(),
                after.iter().sum::<usize>(),
                cleared.unclear.len()
            );
            // Where a running man's thigh is highest the skin at his groin folds into itself, which no turn cures.
            let folds = usize::from(figure == Figure::Man && name == "run");
            let left = after.iter().filter(|pairs| **pairs > 0).count();
            assert!(left <= 2 * folds, "{left} phases");
            // What is clear is left as it is, to the bit.
            let again = cleared.clip.cleared(&body, 0.01);
            assert_eq!(again.clip == cleared.clip, again.largest_turn == [0.0; 2]);
        }
    }
}
