//! Walk and run over the ground: standing feet stand still, joints turn as people's do, nothing jumps.

use toile_body::{Clip, Figure, Joint, Mannequin, Pose};
use toile_geometry::Vec3;
use toile_measure::Measurements;

fn bodies() -> Vec<Mannequin> {
    let people = [
        (Measurements::adult_woman(), Figure::Woman),
        (Measurements::adult_man(), Figure::Man),
    ];
    let new = |(table, figure): &(Measurements, Figure)| Mannequin::new(table, *figure).unwrap();
    people.iter().map(new).collect()
}

/// The lowest places of both feet (m) at a time: heel and ball of each.
fn soles(body: &Mannequin, clip: &Clip, time: f64) -> [[Vec3; 2]; 2] {
    let skeleton = body.skeleton();
    let frames = skeleton.frames(&clip.pose_for(skeleton, time));
    let over = clip.travelled(time) * skeleton.leg_length();
    [
        [Joint::LAnkle, Joint::LMidtarsal],
        [Joint::RAnkle, Joint::RMidtarsal],
    ]
    .map(|[ankle, toes]| {
        let (a, t) = (skeleton.centre(ankle), skeleton.centre(toes));
        let heel = Vec3::new(0.0, -a.y, -0.3 * (t.z - a.z));
        let ball = Vec3::new(0.0, -a.y, t.z - a.z);
        [heel, ball].map(|p| {
            let at = frames.body_from_joint(ankle) * nalgebra::Point3::from(p);
            at.coords + over
        })
    })
}

#[test]
fn a_standing_foot_stands_still_while_the_figure_goes_on() {
    for body in bodies() {
        let skeleton = body.skeleton();
        for (name, clip) in [("walk", Clip::walk(skeleton)), ("run", Clip::run(skeleton))] {
            let count = 960;
            let step = clip.duration() / f64::from(count);
            let (mut slide, mut longest, mut lowest) = (0.0_f64, 0, 0.0_f64);
            // A point of a sole that lies on the ground does not move along it.
            for foot in 0..2 {
                for point in 0..2 {
                    let mut began: Option<Vec3> = None;
                    let mut stood = 0;
                    for k in 0..2 * count {
                        let p = soles(&body, &clip, f64::from(k) * step)[foot][point];
                        lowest = lowest.min(p.y);
                        if p.y > 5e-4 {
                            began = None;
                            stood = 0;
                            continue;
                        }
                        let from = *began.get_or_insert(p);
                        stood += 1;
                        longest = longest.max(stood);
                        slide = slide.max((p - from).xz().norm());
                    }
                }
            }
            println!(
                "{:?} {name}: slides {:.1} mm, stands {:.2} of a stride, sinks {:.1} mm",
                body.figure(),
                slide * 1e3,
                f64::from(longest) / f64::from(count),
                -lowest * 1e3
            );
            assert!(slide < 0.01 && lowest > -3e-3, "{slide} {lowest}");
            assert!(longest > count / 8, "{longest}");
        }
    }
}

/// Signed angle of a joint about x (rad).
fn about_x(pose: &Pose, joint: Joint) -> f64 {
    pose.rotation(joint).scaled_axis().x
}

#[test]
fn joints_turn_as_far_and_as_fast_as_peoples() {
    for body in bodies() {
        let skeleton = body.skeleton();
        for (name, clip, knee) in [
            ("walk", Clip::walk(skeleton), [0.75, 1.35]),
            ("run", Clip::run(skeleton), [1.1, 2.2]),
        ] {
            let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
            let mut fastest = 0.0_f64;
            let h = 1e-3;
            for k in 0..480 {
                let time = f64::from(k) / 480.0 * clip.duration();
                let [a, b] = [time, time + h].map(|time| clip.at(time));
                for (range, joint) in
                    range
                        .iter_mut()
                        .zip([Joint::LHip, Joint::LKnee, Joint::LAnkle])
                {
                    let angle = about_x(&a, joint);
                    *range = [range[0].min(angle), range[1].max(angle)];
                }
                for joint in Joint::ALL {
                    fastest = fastest.max(a.rotation(joint).angle_to(&b.rotation(joint)) / h);
                }
            }
            let degrees = range.map(|r| r.map(|x| x.to_degrees().round()));
            println!(
                "{:?} {name}: hip, knee, ankle {degrees:?} degrees, fastest joint {fastest:.1} rad/s",
                body.figure()
            );
            assert!(fastest < 25.0, "{fastest}");
            assert!(range[1][0] > -0.02, "a knee bends back: {degrees:?}");
            assert!((knee[0]..knee[1]).contains(&range[1][1]), "{degrees:?}");
            // From 20 to 50 degrees forward, 5 to 30 back.
            assert!(range[0][0] > -1.05 && range[0][1] < 0.55, "{degrees:?}");
        }
    }
}
