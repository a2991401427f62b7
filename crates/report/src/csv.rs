//! CSV: numbers with as many digits as it takes to read the same bits back, an empty cell for a missing value.

use apportion::uncertainty::Estimate;
use apportion_base::text::inert;

/// The cells of a value in a file: one, or three of an estimate and the bounds of its interval.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Value(pub(super) Vec<String>);

/// Formats lines of CSV.
pub(super) fn lines(lines: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut writer = ::csv::WriterBuilder::new().flexible(true).from_writer(Vec::new());
    lines.into_iter().for_each(|line| writer.write_record(line).expect("into memory"));
    String::from_utf8(writer.into_inner().expect("into memory")).expect("text in, text out")
}

/// Formats a number that reads back to the same bits; empty for `None`.
fn exact(value: Option<f64>) -> String {
    value.filter(|value| value.is_finite()).map_or_else(String::new, |value| value.to_string())
}

fn of_estimate(estimate: Option<Estimate>) -> Vec<String> {
    let interval = estimate.and_then(|estimate| estimate.interval);
    [estimate.map(|of| of.estimate), interval.map(|of| of.low), interval.map(|of| of.high)].map(exact).to_vec()
}

/// Declares how a value of each type is written in a table.
macro_rules! values {
    ($($type:ty => $cells:expr;)+) => {
        $(impl From<$type> for Value {
            fn from(of: $type) -> Self {
                Self($cells(of))
            }
        })+
    };
}

values! {
    &str => |text: &str| vec![inert(text.to_owned())];
    &String => |text: &String| vec![inert(text.clone())];
    String => |text| vec![inert(text)];
    f64 => |number| vec![exact(Some(number))];
    u64 => |count: u64| vec![count.to_string()];
    bool => |flag: bool| vec![flag.to_string()];
    Estimate => |estimate| of_estimate(Some(estimate));
    Option<Estimate> => of_estimate;
    Option<f64> => |number| vec![exact(number)];
    Option<&str> => |text: Option<&str>| vec![text.map_or_else(String::new, |text| inert(text.to_owned()))];
    Option<bool> => |flag: Option<bool>| vec![flag.map_or_else(String::new, |flag| flag.to_string())];
}
