//! Long runs of garments worn over one another: the shipped patterns, three layers on every mannequin.

use super::worn::Worn;
use std::path::PathBuf;
use std::time::Instant;
use toile_session::{Command, Figure, OtherGarment, Quality};
use toile_tests::root;

/// What is worn, innermost first: every pattern that ships is worn over and under another.
const OUTFITS: [[&str; 3]; 3] = [
    ["trousers", "t-shirt", "poncho"],
    ["gathered-skirt", "t-shirt", "poncho"],
    ["t-shirt", "trousers", "poncho"],
];

/// Wears the outfits on every mannequin, or on those named.
pub fn layers(arguments: &[String]) -> Result<(), String> {
    let mut quality = Quality::Preview;
    let mut names = Vec::new();
    let mut outfits: Vec<[&str; 3]> = OUTFITS.to_vec();
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        match argument.as_str() {
            "--fit" => quality = Quality::Fit,
            "--outfit" => {
                let number = rest.next().and_then(|text| text.parse::<usize>().ok());
                let outfit = number.and_then(|number| OUTFITS.get(number.wrapping_sub(1)));
                outfits = vec![*outfit.ok_or("--outfit needs 1, 2 or 3")?];
            }
            option if option.starts_with("--") => return Err(format!("{option} is not known")),
            name => names.push(name.to_owned()),
        }
    }
    println!(
        "body,inner,middle,outer,vertices,found,astray,body_crossings,cloth_crossings,layer_crossings,astray_end,residual,wall_s"
    );
    let mut left = Vec::new();
    // Outfits have sleeves, which a dress form does not wear.
    let whole = Figure::ALL
        .into_iter()
        .filter(|&figure| figure != Figure::DressForm);
    for figure in whole {
        if !names.is_empty() && !names.iter().any(|name| name == figure.name()) {
            continue;
        }
        for &outfit in &outfits {
            let worn = format!("{},{}", figure.name(), outfit.join(","));
            let start = Instant::now();
            match wear(figure, outfit, quality) {
                Ok(Worn {
                    run,
                    measures,
                    at_rest,
                }) => {
                    let sum = |count: fn(&toile_drape::LayerMeasures) -> usize| {
                        measures.layers.iter().map(count).sum::<usize>()
                    };
                    let astray = sum(|layer| layer.astray);
                    let tally = run.cloth_tally();
                    println!(
                        "{worn},{},{},{},{},{},{},{astray},{:.1e},{:.1}",
                        run.state.positions.len(),
                        tally.crossings[0],
                        tally.astray[0],
                        measures.body_intersections,
                        measures.self_intersections,
                        sum(|layer| layer.outer_intersections),
                        measures.residual,
                        start.elapsed().as_secs_f64()
                    );
                    let wrong = measures.body_intersections + measures.self_intersections + astray;
                    if wrong > 0 || !at_rest {
                        left.push(worn);
                    }
                }
                Err(error) => {
                    println!("{worn},,,,,,,,,{error}");
                    left.push(worn);
                }
            }
        }
    }
    match left.is_empty() {
        true => Ok(()),
        false => Err(format!("not in order or not at rest: {}", left.join("; "))),
    }
}

/// Drapes an outfit to rest.
fn wear(figure: Figure, outfit: [&str; 3], quality: Quality) -> Result<Worn, String> {
    let path = |name: &str| -> PathBuf { root().join(format!("patterns/{name}.toile.json")) };
    let other = |k: usize| OtherGarment {
        path: path(outfit[k]),
        layer: k as u16 + 1,
    };
    super::worn::worn([
        Command::open(path(outfit[0])),
        Command::SetLayers {
            layer: 1,
            others: vec![other(1), other(2)],
        },
        Command::SetBody {
            figure: Some(figure),
            measurements: None,
        },
        Command::SetQuality { quality },
    ])
}
