#![no_main]

apportion_fuzz::fuzz!("parquet");
