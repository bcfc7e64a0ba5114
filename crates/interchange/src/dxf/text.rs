//! Texts of DXF files: `\U+XXXX`, UTF-8, the code page that the file names, GBK, Windows-1252.

use encoding_rs::{BIG5, EUC_KR, Encoding, GBK, SHIFT_JIS, UTF_8, WINDOWS_1252};

/// The encoding of a file's texts.
#[derive(Clone, Copy, Debug)]
pub(super) struct TextEncoding(&'static Encoding);

impl TextEncoding {
    /// The encoding of a file: UTF-8 if all of it is; else the code page that its header names
    /// (`$DWGCODEPAGE`), GBK or Windows-1252, the first that fits all of it.
    pub fn of_file(bytes: &[u8], code_page: &[u8]) -> Self {
        let name = String::from_utf8_lossy(code_page).to_lowercase();
        let stated = match name.as_str() {
            "ansi_932" => Some(SHIFT_JIS),
            "ansi_936" | "gb2312" => Some(GBK),
            "ansi_949" | "johab" => Some(EUC_KR),
            "ansi_950" => Some(BIG5),
            name => {
                let page = name.strip_prefix("ansi_");
                let page = page.map(|page| format!("windows-{page}"));
                page.and_then(|page| Encoding::for_label(page.as_bytes()))
            }
        };
        // Bytes of Chinese signs stand in pairs, accented letters mostly alone.
        let beyond = bytes.iter().filter(|byte| !byte.is_ascii()).count();
        let is_alone =
            |around: &&[u8]| [0, 1, 2].map(|k| around[k].is_ascii()) == [true, false, true];
        let is_chinese = 2 * bytes.windows(3).filter(is_alone).count() < beyond;
        let mut candidates = [Some(UTF_8), stated, is_chinese.then_some(GBK)]
            .into_iter()
            .flatten();
        let fits = |encoding: &&'static Encoding| {
            let found = encoding.decode_without_bom_handling_and_without_replacement(bytes);
            found.is_some()
        };
        Self(candidates.find(fits).unwrap_or(WINDOWS_1252))
    }

    /// A text of the file.
    pub fn decode(self, bytes: &[u8]) -> String {
        unescaped(&self.0.decode_without_bom_handling(bytes).0)
    }
}

/// A text with `\U+XXXX` replaced by the characters of these UTF-16 codes, and `%%` codes by theirs.
fn unescaped(text: &str) -> String {
    let mut units: Vec<u16> = Vec::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let hex = rest
            .strip_prefix("\\U+")
            .or_else(|| rest.strip_prefix("\\u+"))
            .and_then(|after| after.get(..4))
            .and_then(|hex| u16::from_str_radix(hex, 16).ok());
        match hex {
            Some(unit) => {
                units.push(unit);
                rest = &rest[7..];
            }
            None => {
                units.extend_from_slice(c.encode_utf16(&mut [0; 2]));
                rest = &rest[c.len_utf8()..];
            }
        }
    }
    let text = String::from_utf16_lossy(&units);
    [
        ("%%d", "°"),
        ("%%D", "°"),
        ("%%c", "⌀"),
        ("%%C", "⌀"),
        ("%%p", "±"),
        ("%%P", "±"),
    ]
    .iter()
    .fold(text, |text, (code, sign)| text.replace(code, sign))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_several_encodings_are_read() {
        let decoded = |bytes: &[u8], page: &[u8]| TextEncoding::of_file(bytes, page).decode(bytes);
        assert_eq!(decoded("Ärmel".as_bytes(), b"ANSI_1252"), "Ärmel");
        assert_eq!(decoded(b"\\U+00C4rmel", b""), "Ärmel");
        assert_eq!(decoded(b"\\U+D83D\\U+DE00", b""), "\u{1f600}");
        assert_eq!(decoded(b"\xba\xf3\xc6\xac", b""), "后片");
        assert_eq!(decoded(b"\xc4rmel", b"ANSI_1252"), "Ärmel");
        assert_eq!(
            decoded(b" DOS \xc9L\xc9GANT, \xc4rmel ", b"").trim(),
            "DOS ÉLÉGANT, Ärmel"
        );
        assert_eq!(
            decoded(b"\xcf\xee\xeb\xee\xf7\xea\xe0", b"ansi_1251"),
            "Полочка"
        );
        assert_eq!(decoded(b"a\\U+00", b""), "a\\U+00");
    }
}
