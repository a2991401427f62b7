//! The symbols of units, with their prefixes, factors to SI and dimensions.

use super::Dimension;

/// A symbol that prefixes apply to: factor 10^decade times / over to SI.
pub(super) struct Symbol {
    pub name: &'static str,
    prefixes: &'static str,
    pub decade: i32,
    pub times: f64,
    pub over: f64,
    pub offset: f64,
    pub dimension: Dimension,
}

const fn symbol(name: &'static str, prefixes: &'static str, dimension: Dimension) -> Symbol {
    Symbol { name, prefixes, decade: 0, times: 1.0, over: 1.0, offset: 0.0, dimension }
}

/// Creates a symbol without prefixes, whose factor to SI is `times` 10^decade.
const fn multiple(name: &'static str, times: f64, decade: i32, dimension: Dimension) -> Symbol {
    Symbol { decade, times, ..symbol(name, "", dimension) }
}

const CELSIUS: Symbol = Symbol { offset: 273.15, ..symbol("degC", "", Dimension::TEMPERATURE) };
const FAHRENHEIT: Symbol =
    Symbol { offset: 459.67, times: 5.0, over: 9.0, ..symbol("degF", "", Dimension::TEMPERATURE) };

/// Hundreds of seconds in a Julian year, of 365.25 days.
const YEAR: f64 = 315_576.0;

const SYMBOLS: [Symbol; 51] = [
    symbol("m", "kcmunp", Dimension::LENGTH),
    Symbol { decade: -3, ..symbol("g", "kmunp", Dimension::MASS) },
    symbol("s", "munp", Dimension::TIME),
    symbol("Hz", "GMkm", Dimension::FREQUENCY),
    symbol("N", "GMkmunp", Dimension::FORCE),
    symbol("Pa", "GMkmun", Dimension::PRESSURE),
    symbol("J", "GMkmunp", Dimension::ENERGY),
    symbol("W", "GMkmunp", Dimension::POWER),
    symbol("A", "kmunp", Dimension::CURRENT),
    symbol("C", "munp", Dimension::CHARGE),
    symbol("V", "Mkmun", Dimension::VOLTAGE),
    symbol("ohm", "GMkmu", Dimension::RESISTANCE),
    symbol("\u{3a9}", "GMkmu", Dimension::RESISTANCE),
    symbol("F", "munp", Dimension::CAPACITANCE),
    symbol("T", "mun", Dimension::FLUX_DENSITY),
    symbol("K", "mun", Dimension::TEMPERATURE),
    symbol("mol", "kmunp", Dimension::AMOUNT),
    Symbol { decade: -3, ..symbol("L", "mun", Dimension::VOLUME) },
    Symbol { decade: -3, ..symbol("l", "mun", Dimension::VOLUME) },
    Symbol { decade: 5, ..symbol("bar", "m", Dimension::PRESSURE) },
    symbol("rad", "munp", Dimension::ANGLE),
    symbol("deg", "m", Dimension::ANGLE),
    symbol("°", "", Dimension::ANGLE),
    multiple("sec", 1.0, 0, Dimension::TIME),
    multiple("min", 6.0, 1, Dimension::TIME),
    multiple("h", 36.0, 2, Dimension::TIME),
    multiple("hour", 36.0, 2, Dimension::TIME),
    multiple("hours", 36.0, 2, Dimension::TIME),
    multiple("d", 864.0, 2, Dimension::TIME),
    multiple("day", 864.0, 2, Dimension::TIME),
    multiple("days", 864.0, 2, Dimension::TIME),
    multiple("yr", YEAR, 2, Dimension::TIME),
    multiple("year", YEAR, 2, Dimension::TIME),
    multiple("years", YEAR, 2, Dimension::TIME),
    multiple("angstrom", 1.0, -10, Dimension::LENGTH),
    multiple("\u{c5}", 1.0, -10, Dimension::LENGTH),
    multiple("inch", 254.0, -4, Dimension::LENGTH),
    multiple("in", 254.0, -4, Dimension::LENGTH),
    multiple("ft", 3048.0, -4, Dimension::LENGTH),
    // A pound, 0.45359237 kg, at 9.80665 m/s2 on a square inch.
    Symbol { over: 64_516.0, ..multiple("psi", 44_482_216_152_605.0, -5, Dimension::PRESSURE) },
    multiple("atm", 101_325.0, 0, Dimension::PRESSURE),
    Symbol { prefixes: "GMkm", ..multiple("Wh", 36.0, 2, Dimension::ENERGY) },
    Symbol { prefixes: "GMkm", ..multiple("eV", 1_602_176_634.0, -28, Dimension::ENERGY) },
    CELSIUS,
    Symbol { name: "\u{b0}C", ..CELSIUS },
    FAHRENHEIT,
    Symbol { name: "\u{b0}F", ..FAHRENHEIT },
    multiple("%", 1.0, -2, Dimension::NUMBER),
    multiple("ppm", 1.0, -6, Dimension::NUMBER),
    multiple("ppb", 1.0, -9, Dimension::NUMBER),
    symbol("1", "", Dimension::NUMBER),
];

const PREFIXES: [(char, i32); 8] =
    [('G', 9), ('M', 6), ('k', 3), ('c', -2), ('m', -3), ('u', -6), ('n', -9), ('p', -12)];

/// Iterates over every spelling of every symbol with its prefix, and the decade that the prefix adds.
pub(super) fn spellings() -> impl Iterator<Item = (String, &'static Symbol, i32)> {
    SYMBOLS.iter().flat_map(|symbol| {
        let prefixed = PREFIXES.iter().filter(|(prefix, _)| symbol.prefixes.contains(*prefix));
        let bare = std::iter::once((symbol.name.to_owned(), symbol, 0));
        bare.chain(prefixed.map(move |(prefix, decade)| (format!("{prefix}{}", symbol.name), symbol, *decade)))
    })
}

/// Returns the symbol of that name with the decade of its prefix, or the two symbols joined in it.
pub(super) fn lookup(name: &str) -> Option<Vec<(&'static Symbol, i32)>> {
    single(name).or_else(|| juxtaposed(name))
}

fn single(name: &str) -> Option<Vec<(&'static Symbol, i32)>> {
    let (_, symbol, decade) = spellings().find(|(spelling, ..)| spelling == name)?;
    Some(vec![(symbol, decade)])
}

/// Splits two symbols without a sign between them, as in `Ns/m`; only after `N`, `Pa`, `J`: unambiguous.
fn juxtaposed(name: &str) -> Option<Vec<(&'static Symbol, i32)>> {
    spellings().filter(|(_, symbol, _)| matches!(symbol.name, "N" | "Pa" | "J")).find_map(
        |(spelling, symbol, prefix)| {
            let rest = name.strip_prefix(spelling.as_str())?;
            let mut second = single(rest).filter(|symbols| matches!(symbols[0].0.name, "m" | "s"))?;
            second.insert(0, (symbol, prefix));
            Some(second)
        },
    )
}

/// Returns the spelling at most one edit away; a difference in case counts least.
pub(super) fn nearest(name: &str) -> Option<String> {
    let folded_name = name.to_lowercase();
    let mut candidates = Vec::new();
    for (spelling, ..) in spellings().filter(|(spelling, ..)| spelling.chars().count() > 1) {
        let folded = strsim::damerau_levenshtein(&folded_name, &spelling.to_lowercase());
        if folded <= 1 {
            candidates.push(((folded, strsim::damerau_levenshtein(name, &spelling)), spelling));
        }
    }
    candidates.into_iter().min_by_key(|(distance, _)| *distance).map(|(_, spelling)| spelling)
}
