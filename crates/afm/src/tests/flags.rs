use super::*;

#[test]
fn flags_of_a_set_are_listed() {
    let set = Flags::NONE.with(Flag::TaborOutOfRange, true).with(Flag::LargeContact, true);
    assert_eq!(set.iter().collect::<Vec<_>>(), [Flag::LargeContact, Flag::TaborOutOfRange]);
    assert_eq!(set.with(Flag::LargeContact, false), set, "with adds, it never removes");
    assert!(!set.contains(Flag::LargeTwist));
}
