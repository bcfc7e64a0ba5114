//! Sizes of the pieces of a file, from small to large.

use super::block_piece::BlockPiece;

/// Names of the sizes, from small to large: numbers by value, letters by the trade's order, others as the file
/// has them. Empty if the pieces have one size only.
pub(super) fn sizes(pieces: &[(String, Vec<BlockPiece>)]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for piece in pieces.iter().flat_map(|(_, blocks)| blocks) {
        if let Some(size) = piece.size().filter(|size| !names.contains(size)) {
            names.push(size);
        }
    }
    if names.len() < 2 {
        return Vec::new();
    }
    let numbers: Option<Vec<f64>> = names.iter().map(|name| name.parse().ok()).collect();
    let letters: Option<Vec<f64>> = names.iter().map(|name| letter_rank(name)).collect();
    if let Some(ranks) = numbers.or(letters) {
        let mut order: Vec<usize> = (0..names.len()).collect();
        order.sort_by(|&a, &b| ranks[a].total_cmp(&ranks[b]));
        return order.into_iter().map(|k| names[k].clone()).collect();
    }
    names
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
    use super::letter_rank;

    #[test]
    fn letters_of_sizes_have_their_order() {
        let names = ["3XS", "XXS", "XS", "S", "M", "L", "XL", "2XL", "XXXL"];
        let ranks: Vec<f64> = names
            .iter()
            .map(|name| letter_rank(name).unwrap())
            .collect();
        assert!(ranks.is_sorted_by(|a, b| a < b), "{ranks:?}");
        assert_eq!(letter_rank("38"), None);
        assert_eq!(letter_rank("TALL"), None);
        assert_eq!(letter_rank("XÁ"), None);
        assert_eq!(letter_rank(""), None);
    }
}
