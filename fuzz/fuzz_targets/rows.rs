#![no_main]

apportion_fuzz::fuzz!("rows");
