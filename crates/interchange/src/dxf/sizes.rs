//! Sizes of the pieces of a file, from small to large.

/// Least number that is a size by itself.
const MIN_NUMBER: f64 = 20.0;

/// Sizes from small to large: numbers by value, letters by the trade's order, others as the file has them. Empty if
/// there is one size only.
pub(super) fn ordered(names: Vec<String>) -> Vec<String> {
    if names.len() < 2 {
        return Vec::new();
    }
    let ranks = |rank: &dyn Fn(&str) -> Option<f64>| -> Option<Vec<f64>> {
        names.iter().map(|name| rank(name)).collect()
    };
    // Numbers with the same letters before or after them, as in 38W and 40W.
    let letters = |name: &str| name.replace(|c: char| c.is_ascii_digit(), "");
    let numbered = |name: &str| {
        let digits: String = name.chars().filter(char::is_ascii_digit).collect();
        let is_alike = letters(name) == letters(&names[0]);
        digits.parse().ok().filter(|_| is_alike)
    };
    let found = ranks(&|name| name.parse().ok())
        .or_else(|| ranks(&letter_rank))
        .or_else(|| ranks(&numbered));
    let Some(ranks) = found else {
        return names;
    };
    let mut order: Vec<usize> = (0..names.len()).collect();
    order.sort_by(|&a, &b| ranks[a].total_cmp(&ranks[b]));
    order.into_iter().map(|k| names[k].clone()).collect()
}

/// Whether a word is a size by itself: letters of the trade, or a number that counts no pieces.
pub(super) fn is_size(word: &str) -> bool {
    letter_rank(word).is_some() || word.parse().is_ok_and(|number: f64| number >= MIN_NUMBER)
}

/// Rank of a size in letters, as in XS, M, 2XL; `None` for other words.
fn letter_rank(name: &str) -> Option<f64> {
    let name = name.to_uppercase();
    let (digits, letters) = name.split_at(name.find(|c: char| !c.is_ascii_digit())?);
    let last = letters.chars().next_back()?;
    let xs = &letters[..letters.len() - last.len_utf8()];
    if !xs.chars().all(|c| c == 'X') {
        return None;
    }
    let times = match digits.parse::<f64>() {
        Ok(times) if xs.len() == 1 => times,
        Ok(_) => return None,
        Err(_) => xs.len() as f64,
    };
    match last {
        'S' => Some(-1.0 - times),
        'M' if times == 0.0 => Some(0.0),
        'L' => Some(1.0 + times),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_of_sizes_have_their_order() {
        let names = ["3XS", "XXS", "XS", "S", "M", "L", "XL", "2XL", "XXXL"];
        let ranks: Vec<f64> = names
            .iter()
            .map(|name| letter_rank(name).unwrap())
            .collect();
        assert!(ranks.is_sorted_by(|a, b| a < b), "{ranks:?}");
        let sorted = |names: [&str; 3]| ordered(names.map(str::to_owned).to_vec());
        assert_eq!(sorted(["10", "8", "12"]), ["8", "10", "12"]);
        assert_eq!(sorted(["10W", "8W", "12W"]), ["8W", "10W", "12W"]);
        assert_eq!(sorted(["TALL", "SHORT", "M"]), ["TALL", "SHORT", "M"]);
        assert!(is_size("XL") && is_size("38") && !is_size("1") && !is_size("FRONT"));
        assert_eq!(letter_rank("38"), None);
        assert_eq!(letter_rank("TALL"), None);
        assert_eq!(letter_rank("XÁ"), None);
        assert_eq!(letter_rank(""), None);
    }
}
