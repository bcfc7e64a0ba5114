//! Digests of bytes, by which changed files and jobs are told apart.

/// FNV-1a of bytes, 64 bits in hexadecimal digits (Fowler, Noll and Vo 1991).
pub(crate) fn digest(bytes: &[u8]) -> String {
    let step = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    format!("{:016x}", bytes.iter().fold(0xcbf2_9ce4_8422_2325, step))
}

#[cfg(test)]
mod tests {
    use super::digest;

    /// Values of the authors' test suite.
    #[test]
    fn digests_are_those_of_the_authors() {
        assert_eq!(digest(b""), "cbf29ce484222325");
        assert_eq!(digest(b"foobar"), "85944171f73967e8");
    }
}
