//! x
pub fn fold_count(){} 
pub fn shadow_area(){}
