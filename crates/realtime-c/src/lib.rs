//! Clothes in real time for programs in C: the functions of `include/toile_realtime.h`.
//!
//! The only crate with `unsafe`: pointers of the caller are read and written here and nowhere else. NULL
//! is borne everywhere; other pointers must be what the header says.
#![allow(unsafe_code)]

use std::ffi::{CStr, c_char, c_float, c_int};
use std::ptr::null_mut;
use std::slice;
use toile_realtime::{CharacterFile, Ellipsoids, Garment, GarmentSettings};

/// Room of the caller for a message.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Message {
    text: *mut c_char,
    room: usize,
}

impl Message {
    /// Writes as much of a text as there is room for, and a 0 behind it.
    ///
    /// # Safety
    /// `text` is NULL or has `room` bytes.
    unsafe fn say(self, words: &str) {
        if self.text.is_null() || self.room == 0 {
            return;
        }
        let length = words.len().min(self.room - 1);
        // SAFETY: there are `room` bytes by the contract, and `length` is less.
        let into = unsafe { slice::from_raw_parts_mut(self.text.cast::<u8>(), self.room) };
        into[..length].copy_from_slice(&words.as_bytes()[..length]);
        into[length] = 0;
    }
}

fn read(text: &[u8]) -> Result<Ellipsoids, String> {
    let file: CharacterFile = serde_json::from_slice(text).map_err(|error| error.to_string())?;
    let character = file.into_character().map_err(|error| error.to_string())?;
    Ellipsoids::new(&character).map_err(|error| error.to_string())
}

/// See the header.
///
/// # Safety
/// `json` is NULL or has `length` bytes; `message` as [`Message`] says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn toile_character_read(
    json: *const c_char,
    length: usize,
    message: Message,
) -> *mut Ellipsoids {
    let read = match json.is_null() {
        true => Err("there is no text; give that of a character file".to_owned()),
        // SAFETY: by the contract.
        false => read(unsafe { slice::from_raw_parts(json.cast::<u8>(), length) }),
    };
    match read {
        Ok(ellipsoids) => Box::into_raw(Box::new(ellipsoids)),
        Err(words) => {
            // SAFETY: by the contract.
            unsafe { message.say(&words) };
            null_mut()
        }
    }
}

/// See the header.
///
/// # Safety
/// NULL or a character that is not freed yet.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn toile_character_free(character: *mut Ellipsoids) {
    if !character.is_null() {
        // SAFETY: it came from `Box::into_raw`.
        drop(unsafe { Box::from_raw(character) });
    }
}

/// See the header.
///
/// # Safety
/// NULL or a living character; `clip` NULL or ending with 0; `message` as [`Message`] says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn toile_character_start(
    character: *mut Ellipsoids,
    clip: *const c_char,
    fade: c_float,
    message: Message,
) -> c_int {
    // SAFETY: by the contract.
    let Some(ellipsoids) = (unsafe { character.as_mut() }) else {
        return 0;
    };
    let name = match clip.is_null() {
        true => Ok(""),
        // SAFETY: by the contract.
        false => unsafe { CStr::from_ptr(clip) }.to_str(),
    };
    let started = ellipsoids.start(name.unwrap_or_default(), fade);
    if let Err(error) = &started {
        // SAFETY: by the contract.
        unsafe { message.say(&error.to_string()) };
    }
    c_int::from(started.is_ok())
}

/// See the header.
///
/// # Safety
/// NULL or a living character.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn toile_character_stop(character: *mut Ellipsoids) {
    // SAFETY: by the contract.
    if let Some(ellipsoids) = unsafe { character.as_mut() } {
        ellipsoids.stop();
    }
}

/// See the header.
///
/// # Safety
/// NULL or a living character.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn toile_character_advance(character: *mut Ellipsoids, dt: c_float) {
    // SAFETY: by the contract.
    if let Some(ellipsoids) = unsafe { character.as_mut() } {
        ellipsoids.advance(dt);
    }
}

/// See the header.
///
/// # Safety
/// NULL or a living character; `rows` is NULL or has 12 numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn toile_character_transform(
    character: *const Ellipsoids,
    ellipsoid: usize,
    rows: *mut c_float,
) -> c_int {
    // SAFETY: by the contract.
    let found = unsafe { character.as_ref() }.and_then(|e| e.transform(ellipsoid));
    let Some(frame) = found.filter(|_| !rows.is_null()) else {
        return 0;
    };
    // SAFETY: by the contract.
    let into = unsafe { slice::from_raw_parts_mut(rows, 12) };
    for (row, into) in into.chunks_mut(4).enumerate() {
        into[..3].copy_from_slice(&frame.rows[row]);
        into[3] = frame.at[row];
    }
    1
}

/// See the header.
///
/// # Safety
/// NULL or a living character; `positions` has three numbers a vertex and `triangles` three a triangle;
/// `message` as [`Message`] says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn toile_garment_new(
    character: *const Ellipsoids,
    positions: *const [c_float; 3],
    vertices: usize,
    triangles: *const [u32; 3],
    triangle_count: usize,
    offset: c_float,
    message: Message,
) -> *mut Garment {
    // SAFETY: by the contract.
    let Some(ellipsoids) = (unsafe { character.as_ref() }) else {
        return null_mut();
    };
    if positions.is_null() || triangles.is_null() {
        return null_mut();
    }
    // SAFETY: by the contract.
    let positions = unsafe { slice::from_raw_parts(positions, vertices) };
    // SAFETY: by the contract.
    let triangles = unsafe { slice::from_raw_parts(triangles, triangle_count) };
    let settings = GarmentSettings {
        offset,
        ..GarmentSettings::default()
    };
    match Garment::new(ellipsoids, positions, triangles, settings) {
        Ok(garment) => Box::into_raw(Box::new(garment)),
        Err(error) => {
            // SAFETY: by the contract.
            unsafe { message.say(&error.to_string()) };
            null_mut()
        }
    }
}

/// See the header.
///
/// # Safety
/// NULL or a garment that is not freed yet.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn toile_garment_free(garment: *mut Garment) {
    if !garment.is_null() {
        // SAFETY: it came from `Box::into_raw`.
        drop(unsafe { Box::from_raw(garment) });
    }
}

/// See the header.
///
/// # Safety
/// NULL or living garment and character.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn toile_garment_adjust_by_gravity(
    garment: *mut Garment,
    character: *const Ellipsoids,
    dt: c_float,
) {
    // SAFETY: by the contract.
    if let (Some(garment), Some(e)) = unsafe { (garment.as_mut(), character.as_ref()) } {
        garment.adjust_by_gravity(e, dt);
    }
}

/// See the header.
///
/// # Safety
/// NULL or living garment and character.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn toile_garment_adjust_by_shape(
    garment: *mut Garment,
    character: *const Ellipsoids,
    dt: c_float,
) {
    // SAFETY: by the contract.
    if let (Some(garment), Some(e)) = unsafe { (garment.as_mut(), character.as_ref()) } {
        garment.adjust_by_shape(e, dt);
    }
}

/// See the header.
///
/// # Safety
/// NULL or a living garment; `positions` is NULL or has three numbers a vertex.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn toile_garment_positions(
    garment: *const Garment,
    positions: *mut [c_float; 3],
) {
    // SAFETY: by the contract.
    let Some(garment) = (unsafe { garment.as_ref() }).filter(|_| !positions.is_null()) else {
        return;
    };
    // SAFETY: by the contract.
    let into = unsafe { slice::from_raw_parts_mut(positions, garment.len()) };
    for (into, place) in into.iter_mut().zip(garment.positions()) {
        *into = place;
    }
}
