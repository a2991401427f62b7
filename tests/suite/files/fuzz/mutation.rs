//! Small changes to texts that keep most of their structure: words, numbers, lines and brackets are moved, removed or added.

use std::ops::Range;

/// Reproducible random numbers: Steele, Lea and Flood's SplitMix64 (OOPSLA 2014).
pub struct Random(pub u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `end`, which is not 0.
    pub fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    fn choose<'a, T>(&mut self, from: &'a [T]) -> Option<&'a T> {
        if from.is_empty() { None } else { from.get(self.below(from.len())) }
    }
}

/// The words of a language.
pub struct Dictionary(Vec<String>);

impl Dictionary {
    /// Reads the format of libFuzzer: a word in quotes on each line, with `\"`, `\\` and `\xAB` in it.
    pub fn read(text: &str) -> Self {
        let word = |line: &str| Some(unescaped(line.trim().strip_prefix('"')?.strip_suffix('"')?));
        Self(text.lines().filter_map(word).collect())
    }
}

fn unescaped(word: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = word.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let hexadecimal = |digits: &[u8]| u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok();
        (rest, bytes) = match (first, after) {
            (b'\\', [b'x', digits @ ..]) if digits.len() >= 2 => {
                bytes.extend(hexadecimal(&digits[..2]));
                (&digits[2..], bytes)
            }
            (b'\\', [escaped, after @ ..]) => {
                bytes.push(*escaped);
                (after, bytes)
            }
            _ => {
                bytes.push(first);
                (after, bytes)
            }
        };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Numbers that often break programs.
const NUMBERS: [&str; 32] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "2",
    "3",
    "255",
    "256",
    "257",
    "4096",
    "65536",
    "4294967296",
    "9007199254740993",
    "9223372036854775807",
    "18446744073709551615",
    "1e-308",
    "5e-324",
    "-5e-324",
    "1e308",
    "-1e308",
    "1.7976931348623157e308",
    "1e-30",
    "1e30",
    "0.1",
    "0.5",
    "0.9999999999999999",
    "1.0000000000000002",
    "1e15",
    "-3",
    "7",
    "1e400",
    "nan",
];

/// `text` with one to four changes.
pub fn mutated(text: &str, dictionary: &Dictionary, random: &mut Random) -> String {
    let mut tokens: Vec<String> = tokens(text);
    for _ in 0..=random.below(4) {
        change(&mut tokens, dictionary, random);
    }
    tokens.concat()
}

fn change(tokens: &mut Vec<String>, dictionary: &Dictionary, random: &mut Random) {
    if tokens.is_empty() {
        tokens.extend(random.choose(&dictionary.0).cloned());
        return;
    }
    let at = random.below(tokens.len());
    match random.below(12) {
        0 | 1 => {
            replace(tokens, random, |token| !token.trim().is_empty(), |random| random.choose(&dictionary.0).cloned())
        }
        2 | 3 => replace(tokens, random, is_number, |random| random.choose(&NUMBERS).map(|&number| number.to_owned())),
        4 => {
            tokens.drain(at..(at + 1 + random.below(8)).min(tokens.len()));
        }
        5 => {
            let copy = tokens[at..(at + 1 + random.below(8)).min(tokens.len())].to_vec();
            let to = random.below(tokens.len() + 1);
            tokens.splice(to..to, copy);
        }
        6 => {
            let word = random.choose(&dictionary.0).cloned();
            tokens.splice(at..at, word);
        }
        7 => {
            let other = random.below(tokens.len());
            tokens.swap(at, other);
        }
        8 => {
            let (line, other) = (line(tokens, at), line(tokens, random.below(tokens.len())));
            let copy = tokens[line.clone()].to_vec();
            match random.below(3) {
                0 => drop(tokens.drain(line)),
                1 => drop(tokens.splice(other.start..other.start, copy)),
                _ => drop(tokens.splice(other, copy)),
            }
        }
        9 => {
            let word = tokens[at].clone();
            replace(
                tokens,
                random,
                |token| is_number(token) == is_number(&word) && is_word(token),
                |_| Some(word.clone()),
            );
        }
        _ => {
            let Some(bracket) = bracket(tokens, random) else { return };
            let inside = bracket.start + 1..bracket.end - 1;
            match random.below(5) {
                0 => drop(tokens.drain(bracket)),
                1 => drop(tokens.drain(inside)),
                2 => drop(tokens.splice(bracket, ["null".to_owned()])),
                3 => {
                    let copy = tokens[inside.clone()].to_vec();
                    let again = [",".to_owned()].into_iter().chain(copy);
                    drop(tokens.splice(inside.end..inside.end, again));
                }
                _ => {
                    let copy = tokens[bracket].to_vec();
                    if let Some(other) = self::bracket(tokens, random) {
                        tokens.splice(other, copy);
                    }
                }
            }
        }
    }
}

fn is_word(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphanumeric() || "_-.".contains(c))
}

fn is_number(token: &str) -> bool {
    token.trim_start_matches(['-', '+', '.']).starts_with(|c: char| c.is_ascii_digit())
}

/// Replaces one of the tokens of a kind.
fn replace(
    tokens: &mut [String],
    random: &mut Random,
    kind: impl Fn(&str) -> bool,
    by: impl FnOnce(&mut Random) -> Option<String>,
) {
    let places: Vec<usize> = (0..tokens.len()).filter(|&place| kind(&tokens[place])).collect();
    if let Some(&place) = random.choose(&places)
        && let Some(word) = by(random)
    {
        tokens[place] = word;
    }
}

/// The line around a token, with its end.
fn line(tokens: &[String], at: usize) -> Range<usize> {
    let start = tokens[..at].iter().rposition(|token| token == "\n").map_or(0, |end| end + 1);
    let end = tokens[at..].iter().position(|token| token == "\n").map_or(tokens.len(), |end| at + end + 1);
    start..end
}

/// Some bracket of the text with what it holds.
fn bracket(tokens: &[String], random: &mut Random) -> Option<Range<usize>> {
    let opens = |token: &String| matches!(token.as_str(), "(" | "[" | "{");
    let places: Vec<usize> = (0..tokens.len()).filter(|&place| opens(&tokens[place])).collect();
    let start = *random.choose(&places)?;
    let mut depth = 0;
    for (place, token) in tokens.iter().enumerate().skip(start) {
        match token.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ => (),
        }
        if depth == 0 {
            return Some(start..place + 1);
        }
    }
    None
}

/// Words and numbers, runs of spaces, and every other single character.
fn tokens(text: &str) -> Vec<String> {
    let kind = |c: char| match c {
        c if c.is_alphanumeric() || "_.-".contains(c) => 0,
        ' ' | '\t' => 1,
        _ => 2,
    };
    let mut tokens: Vec<String> = Vec::new();
    let mut last = 2;
    for c in text.chars() {
        match tokens.last_mut() {
            Some(token) if kind(c) == last && last != 2 => token.push(c),
            _ => tokens.push(c.to_string()),
        }
        last = kind(c);
    }
    tokens
}

/// `bytes` with some of them changed, cut out, repeated, or the end cut off.
pub fn mutated_bytes(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let mut changed = bytes.to_vec();
    for _ in 0..=random.below(3) {
        if changed.is_empty() {
            return changed;
        }
        let at = random.below(changed.len());
        let end = (at + 1 + random.below(16)).min(changed.len());
        match random.below(5) {
            0 => changed[at] ^= 1 << random.below(8),
            1 => changed[at..end].fill([0, 0xff][random.below(2)]),
            2 => changed.truncate(at),
            3 => drop(changed.drain(at..end)),
            _ => {
                let again = changed[at..end].to_vec();
                changed.splice(at..at, again);
            }
        }
    }
    changed
}
