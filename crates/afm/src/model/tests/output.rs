use super::*;

#[test]
fn every_unit_is_known() {
    for output in AfmOutput::ALL {
        assert!(Unit::parse(output.row().0).is_ok());
    }
}
