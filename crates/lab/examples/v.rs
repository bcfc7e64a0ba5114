fn main(){ let names: Vec<String>=std::env::args().skip(1).collect(); let c=toile_lab::validate(&names,&mut toile_session::Silent).unwrap(); println!("{}",toile_lab::table(&c)); }
