//! Closed lists: all variants of an enum, with their names where it has some, as the compiler knows them.

/// All variants of an enum that derives `VariantArray` and `EnumCount` of `strum`, as the value of a constant.
#[macro_export]
macro_rules! all_variants {
    () => {
        match <Self as strum::VariantArray>::VARIANTS.first_chunk() {
            Some(all) => *all,
            None => panic!("there are as many as are counted"),
        }
    };
}

/// The same with the name of each, which `VariantNames` of `strum` derives.
#[macro_export]
macro_rules! named_variants {
    () => {{
        let names = <Self as strum::VariantNames>::VARIANTS;
        let variants = <Self as strum::VariantArray>::VARIANTS;
        let mut all = [(names[0], variants[0]); <Self as strum::EnumCount>::COUNT];
        let mut k = 1;
        while k < all.len() {
            all[k] = (names[k], variants[k]);
            k += 1;
        }
        all
    }};
}
