//! Changes to texts word by word. Bytes changed at random make words that no reader knows;
//! these keep the grammar more often than not, and reach what is behind it.

use std::ops::Range;

/// Numbers at the edges of something.
const EDGES: [&str; 24] = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "3",
    "0.5",
    "1e-3",
    "1e-9",
    "1e-16",
    "5e-324",
    "1e-310",
    "1e-160",
    "1e-75",
    "1e15",
    "1e75",
    "1e77",
    "1e153",
    "1e155",
    "1e308",
    "-1e308",
    "4294967295",
    "inf",
    "nan",
];

/// Changes the text in the first `size` bytes in one or a few places; returns its new size,
/// which is at most the length of `data`.
pub fn mutate(data: &mut [u8], size: usize, seed: u32) -> usize {
    let mut dice = Dice(u64::from(seed) << 1 | 1);
    let mut text = data[..size].to_vec();
    for _ in 0..=dice.below(3) {
        change(&mut text, &mut dice);
    }
    let size = text.len().min(data.len());
    data[..size].copy_from_slice(&text[..size]);
    size
}

fn change(text: &mut Vec<u8>, dice: &mut Dice) {
    let words = words(text);
    if words.is_empty() {
        return;
    }
    let numbers: Vec<&Range<usize>> =
        words.iter().filter(|at| number(&text[(*at).clone()]).is_some()).collect();
    let some = |dice: &mut Dice| words[dice.below(words.len())].clone();
    // A few words in a row.
    let stretch = |dice: &mut Dice| {
        let from = dice.below(words.len());
        let most = if dice.below(2) == 0 { 4 } else { 40 };
        let to = (from + dice.below(most)).min(words.len() - 1);
        words[from].start..words[to].end
    };
    match dice.below(10) {
        0 => drop(text.drain(stretch(dice))),
        1 | 2 => {
            let (piece, at) = (text[stretch(dice)].to_vec(), some(dice).start);
            text.splice(at..at, piece);
        }
        3 => {
            let (piece, at) = (text[some(dice)].to_vec(), some(dice));
            text.splice(at, piece);
        }
        4 if !numbers.is_empty() => {
            let factor = 10_f64
                .powi([-300, -150, -60, -9, -1, 1, 9, 60, 150, 300][dice.below(10)]);
            let places: Vec<Range<usize>> = numbers.into_iter().rev().cloned().collect();
            for at in places {
                let scaled = number(&text[at.clone()]).unwrap_or_default() * factor;
                text.splice(at, format!("{scaled:e}").into_bytes());
            }
        }
        _ if !numbers.is_empty() => {
            let at = numbers[dice.below(numbers.len())].clone();
            let other = numbers[dice.below(numbers.len())].clone();
            let x = number(&text[at.clone()]).unwrap_or_default();
            let new = match dice.below(9) {
                0..=2 => EDGES[dice.below(EDGES.len())].to_owned(),
                3 => String::from_utf8_lossy(&text[other]).into_owned(),
                4 => (-x).to_string(),
                5 => (x + 1.0).to_string(),
                6 => (x - 1.0).to_string(),
                7 => format!("{:e}", x.next_up()),
                _ => {
                    format!("{:e}", x * [0.5, 2.0, 1e-3, 1e3, 1.0 + 1e-15][dice.below(5)])
                }
            };
            text.splice(at, new.into_bytes());
        }
        _ => {}
    }
}

/// Names and numbers, and every other byte that is not blank.
fn words(text: &[u8]) -> Vec<Range<usize>> {
    let belongs = |b: u8| b.is_ascii_alphanumeric() || b"._$+-".contains(&b);
    let (mut words, mut at) = (Vec::new(), 0);
    while at < text.len() {
        let length = text[at..].iter().take_while(|&&b| belongs(b)).count().max(1);
        if !text[at].is_ascii_whitespace() {
            words.push(at..at + length);
        }
        at += length;
    }
    words
}

fn number(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators",
/// 2014).
struct Dice(u64);

impl Dice {
    /// A number below a limit that is not 0.
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % limit as u64) as usize
    }
}
