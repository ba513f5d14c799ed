//! What crosses engines.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "tests may stop at the first surprise, and may talk"
)]

mod action_modes;
mod agents;
mod agreement;
mod authored;
mod calibration_drive;
mod calibration_flight;
mod calibration_real;
mod calibration_room;
mod calibration_servo;
mod calibration_support;
mod cameras;
mod carrying;
mod contacts;
mod contracts;
mod determinism;
mod dialogue;
mod embodied_qa;
mod fuzzing;
mod generated;
mod goldens;
mod hide_and_seek;
mod instruction_routes;
mod instructions;
mod joint_steps;
mod laws_page;
mod overlap;
mod parameters;
mod rearranging;
mod relations;
mod robots;
mod sensors_body;
mod sensors_map;
mod sensors_sound;
mod shutters;
mod sound_localization;
mod sounds;
mod stated_episodes;
mod tasks;
mod tidying;
mod together;
mod voices;
mod worlds;
