//! A hex mesh for any quad surface that can have one
