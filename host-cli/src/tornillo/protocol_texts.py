# SPDX-License-Identifier: Apache-2.0
"""What the codes of the chip mean to a person.

Generated from protocol.toml by generate_protocol.py: do not edit.
"""

from typing import NamedTuple

from tornillo.protocol import Alarm, ErrorCode, MachineWarning, Refusal


class Explanation(NamedTuple):
    """Why the chip says no, and what a person does next."""

    cause: str
    remedy: str


ERROR_TEXTS = {
    ErrorCode.OK: Explanation(
        "done",
        "nothing to do",
    ),
    ErrorCode.UNKNOWN_COMMAND: Explanation(
        "the firmware does not know this command",
        "update the firmware, or use the tornillo version that belongs to it",
    ),
    ErrorCode.BAD_LENGTH: Explanation(
        "the request has the wrong length for its command",
        "use the tornillo version that belongs to this firmware",
    ),
    ErrorCode.BUSY: Explanation(
        "the lathe is moving",
        "wait until it stands still, or stop it with `tornillo stop`",
    ),
    ErrorCode.NOT_HOMED: Explanation(
        "the lathe does not know where its slides are",
        "run `tornillo home` first",
    ),
    ErrorCode.ALARM: Explanation(
        "an alarm has not been acknowledged",
        "read it with `tornillo status`, remove its cause, then `tornillo reset`",
    ),
    ErrorCode.NO_PART: Explanation(
        "there is no part in that slot, or none is selected",
        "see `tornillo parts`, then `tornillo upload FILE` or `tornillo select PART`",
    ),
    ErrorCode.INVALID_PART: Explanation(
        "the chip refuses the part",
        "correct the part file and upload it again",
    ),
    ErrorCode.OUT_OF_RANGE: Explanation(
        "a value lies outside its range",
        "see the ranges with `tornillo settings`",
    ),
    ErrorCode.NOT_RUNNING: Explanation(
        "no part is being cut that this could act on",
        "start one with `tornillo run PART`",
    ),
    ErrorCode.BAD_OFFSET: Explanation(
        "a piece of a part image does not follow the one before it",
        "upload the part again",
    ),
    ErrorCode.NO_UPLOAD: Explanation(
        "no upload is under way",
        "upload the part again from the start",
    ),
    ErrorCode.CRC_MISMATCH: Explanation(
        "the part did not arrive as it was sent",
        "upload the part again; if it happens often, change the USB cable",
    ),
    ErrorCode.STORE_FULL: Explanation(
        "the chip has no room for one more part",
        "free one with `tornillo delete PART`",
    ),
    ErrorCode.FLASH_FAILED: Explanation(
        "the chip's memory did not keep what was written",
        "try again; if it stays, the chip is worn out or its supply is weak",
    ),
    ErrorCode.ESTOP: Explanation(
        "the emergency stop is pressed or its wire is broken",
        "release the emergency stop, then `tornillo reset`",
    ),
    ErrorCode.PROBE_CLOSED: Explanation(
        "the contact sensor is closed already",
        "move the tool away from the work, or look for chips and a short in the sensor's wire",
    ),
    ErrorCode.NOT_FITTED: Explanation(
        "the machine has no contact sensor",
        (
            "touch by hand and type what you measure (`tornillo zero x --diameter`), or wire a "
            "sensor and `tornillo settings set probe_fitted 1`"
        ),
    ),
    ErrorCode.NOTHING_TO_RESUME: Explanation(
        "no part, or not this one, was begun and not finished",
        "see `tornillo status`; cut a part from its start with `tornillo run PART`",
    ),
    ErrorCode.WRONG_WAY: Explanation(
        "the limit switch at that end is pressed",
        "jog the other way, or home",
    ),
}

ALARM_TEXTS = {
    Alarm.NONE: Explanation(
        "no alarm",
        "nothing to do",
    ),
    Alarm.HOME_NOT_FOUND: Explanation(
        "the slide travelled its whole way and the limit switch did not close",
        (
            "check that the slide moves when its motor turns, then the switch, its wire and the "
            "setting of the travel"
        ),
    ),
    Alarm.HOME_NOT_RELEASED: Explanation(
        "the limit switch stayed closed when the slide backed off",
        "check for a stuck switch or a broken wire, and the direction of the motor",
    ),
    Alarm.LIMIT: Explanation(
        "a limit switch closed while cutting or moving",
        (
            "check part zero and stock, reset, jog away from the switch (`tornillo jog`), then "
            "home again"
        ),
    ),
    Alarm.ESTOP: Explanation(
        "the emergency stop was pressed",
        "make the machine safe, release the emergency stop, reset, then home again",
    ),
    Alarm.STREAM_DRY: Explanation(
        "the steps were not computed in time",
        "reset and home again; please report it with the part file",
    ),
    Alarm.WRONG_SWITCH: Explanation(
        "the switch of the other axis closed while homing",
        "check that the two limit switches, or the two motors, are not exchanged",
    ),
    Alarm.SETTINGS_LOST: Explanation(
        "the stored settings were damaged; the defaults are in use",
        "reset, then check every value with `tornillo settings`",
    ),
    Alarm.STOPPED_HOMING: Explanation(
        "homing was stopped before its end",
        "reset, then home again",
    ),
    Alarm.DEAD_STEPS_SPREAD: Explanation(
        "the dead steps came out differently each time they were measured",
        "check for a loose screw, nut, coupling or switch, reset, then home again",
    ),
    Alarm.PATH: Explanation(
        "an arc whose centre does not fit its ends",
        "reset and home again; please report it with the part file",
    ),
    Alarm.HOME_OPENED_LATE: Explanation(
        "the limit switch opened, but only after more dead steps than the setting dead_max allows",
        (
            "check for a loose nut, screw or coupling, and for a switch that sticks; if the screw "
            "is like that, raise dead_max, reset, then home again"
        ),
    ),
    Alarm.PHASE_DRIFT: Explanation(
        (
            "the limit switch opened at another place than in the last homing: steps were lost, or"
            " the screw, the coupling or the switch has moved"
        ),
        "check all three and the feed, reset, then home again: the new place counts from then on",
    ),
    Alarm.SWITCH_WIRING: Explanation(
        "a limit switch reads closed far from its end: its wire is broken, or many steps were lost",
        "check the switch, its wire and plug, reset, then home again",
    ),
    Alarm.PROBE_UNEXPECTED: Explanation(
        "the tool touched the work while it moved fast",
        "look at tool and work, reset, jog away, then home again",
    ),
}

WARNING_TEXTS = {
    MachineWarning.DEAD_X: Explanation(
        "the dead steps of X are not what the homing before found",
        (
            "look for a loose coupling, nut or screw of X; if it is wear, home again: then these "
            "are the ones to compare with"
        ),
    ),
    MachineWarning.DEAD_Z: Explanation(
        "the dead steps of Z are not what the homing before found",
        (
            "look for a loose coupling, nut or screw of Z; if it is wear, home again: then these "
            "are the ones to compare with"
        ),
    ),
}

REFUSAL_TEXTS = {
    Refusal.FORMAT: Explanation(
        "the image has an unknown format",
        "use the tornillo version that belongs to this firmware",
    ),
    Refusal.LENGTH: Explanation(
        "the image has the wrong length",
        "upload the part again",
    ),
    Refusal.NAME: Explanation(
        "the name cannot be used",
        "use 1 to 16 of the characters a-z, 0-9 and -",
    ),
    Refusal.STEP_SIZE: Explanation(
        "the part was made for other screws",
        "upload it again with the lathe connected, so that its step sizes are used",
    ),
    Refusal.STOCK: Explanation(
        "the stock has no sensible size",
        "give diameter and free length of the stock",
    ),
    Refusal.DEPTH_OF_CUT: Explanation(
        "the depth of cut has no sensible size",
        "give a depth of cut of at least one step and at most the stock's radius",
    ),
    Refusal.FEED: Explanation(
        "a feed is too slow or too fast",
        "give a feed inside the machine's range",
    ),
    Refusal.RETRACT: Explanation(
        "the retract is too small or too large",
        "give a retract of at least one step",
    ),
    Refusal.OPERATION_COUNT: Explanation(
        "the number of operations is wrong",
        "give 1 to 64 operations",
    ),
    Refusal.OPERATION_TYPE: Explanation(
        "the firmware does not know this type of operation",
        "update the firmware, or use another operation",
    ),
    Refusal.OPERATION_SIZE: Explanation(
        "an operation record has the wrong size",
        "use the tornillo version that belongs to this firmware",
    ),
    Refusal.OUTSIDE_STOCK: Explanation(
        "the operation lies outside the stock",
        "keep the operation inside the stock and at least one retract in front of the chuck",
    ),
    Refusal.OUTSIDE_TRAVEL: Explanation(
        "the slides cannot go that far",
        "check part zero (`tornillo zero`), the stock and the travel",
    ),
    Refusal.EMPTY_CUT: Explanation(
        "the operation has nothing to cut",
        "order z from the free end towards the chuck and make the cut smaller than the stock",
    ),
    Refusal.BLOCKED: Explanation(
        "material in front of the operation keeps the tool out",
        "cut the part in front first, start at the front face, or use a tool that can plunge",
    ),
    Refusal.ALLOWANCE: Explanation(
        "the finish allowance is too large",
        "leave at most one depth of cut for finishing",
    ),
    Refusal.ORDER: Explanation(
        "the tool or its cutting data are missing",
        "use the tornillo version that belongs to this firmware",
    ),
    Refusal.TOOL: Explanation(
        "this tool cannot make such a cut",
        "turn with a turning tool; cut grooves and part off with a tool that has a `width`",
    ),
    Refusal.ARC: Explanation(
        "there is no such arc",
        (
            "check the ends and the radius: it is at least half the distance of the ends, and the "
            "arc never runs back"
        ),
    ),
    Refusal.BACK_EDGE: Explanation(
        "the back edge of the tool would cut into the work",
        "make it less steep, or use a tool with more back clearance",
    ),
    Refusal.FRONT_EDGE: Explanation(
        "the front edge of the tool would cut into the work",
        "make it less steep, or use a tool with more front clearance",
    ),
    Refusal.DIRECTION: Explanation(
        "the contour runs the wrong way",
        "order the points from the free end towards the chuck",
    ),
    Refusal.SPINDLE: Explanation(
        "the spindle cannot turn at that speed",
        "give a spindle speed inside the machine's range",
    ),
}
