//! Letters of five by seven dots, so that pictures need no fonts of the machine.

/// The width of a letter in dots, including the gap after it.
pub const LETTER_WIDTH: u32 = 6;

/// The height of a letter in dots.
pub const LETTER_HEIGHT: u32 = 7;

/// Returns the rows of a letter from the top, or `None` for an unknown letter. The highest of five bits is the leftmost
/// dot.
#[rustfmt::skip]
pub const fn letter_rows(letter: char) -> Option<[u8; LETTER_HEIGHT as usize]> {
    Some(match letter {
        '0' => [0b01110, 0b10001, 0b10011, 0b10101, 0b11001, 0b10001, 0b01110],
        '1' => [0b00100, 0b01100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110],
        '2' => [0b01110, 0b10001, 0b00001, 0b00110, 0b01000, 0b10000, 0b11111],
        '3' => [0b11110, 0b00001, 0b00001, 0b01110, 0b00001, 0b00001, 0b11110],
        '4' => [0b00010, 0b00110, 0b01010, 0b10010, 0b11111, 0b00010, 0b00010],
        '5' => [0b11111, 0b10000, 0b11110, 0b00001, 0b00001, 0b10001, 0b01110],
        '6' => [0b00110, 0b01000, 0b10000, 0b11110, 0b10001, 0b10001, 0b01110],
        '7' => [0b11111, 0b00001, 0b00010, 0b00100, 0b01000, 0b01000, 0b01000],
        '8' => [0b01110, 0b10001, 0b10001, 0b01110, 0b10001, 0b10001, 0b01110],
        '9' => [0b01110, 0b10001, 0b10001, 0b01111, 0b00001, 0b00010, 0b01100],
        '.' => [0, 0, 0, 0, 0, 0b01100, 0b01100],
        '-' => [0, 0, 0, 0b11111, 0, 0, 0],
        '+' => [0, 0b00100, 0b00100, 0b11111, 0b00100, 0b00100, 0],
        'a' => [0, 0, 0b01110, 0b00001, 0b01111, 0b10001, 0b01111],
        'e' => [0, 0, 0b01110, 0b10001, 0b11111, 0b10000, 0b01110],
        'f' => [0b00110, 0b01001, 0b01000, 0b11100, 0b01000, 0b01000, 0b01000],
        'i' => [0b00100, 0, 0b01100, 0b00100, 0b00100, 0b00100, 0b01110],
        'n' => [0, 0, 0b10110, 0b11001, 0b10001, 0b10001, 0b10001],
        'p' => [0, 0, 0b11110, 0b10001, 0b11110, 0b10000, 0b10000],
        's' => [0, 0, 0b01111, 0b10000, 0b01110, 0b00001, 0b11110],
        't' => [0b01000, 0b01000, 0b11100, 0b01000, 0b01000, 0b01001, 0b00110],
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::letter_rows;
    use crate::number::format_short;

    #[test]
    fn every_label_can_be_written() {
        let numbers = [-1234.5678, 1e-300, 9e99, f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(format_short).concat();
        for letter in format!("step {} t {numbers}+", u32::MAX).chars().filter(|&letter| letter != ' ') {
            assert!(letter_rows(letter).is_some_and(|rows| rows.iter().any(|&row| row > 0)), "{letter}");
        }
    }
}
