# SPDX-License-Identifier: CERN-OHL-P-2.0
"""A deliberate fault of each kind, and the check that must find it."""

from __future__ import annotations

import re

from hardware.spoiled_board import Board

PROJECT = "hw/kicad/tornillo"


def test_the_committed_board_passes_all_checks_but_the_long_spice_runs(board: Board) -> None:
    verdict = board.check("generated", "erc", "drc", "nets")
    assert verdict.status == 0, verdict.output


def test_swapped_usb_lines_make_the_board_target_fail(board: Board) -> None:
    board.edit("hw/kicad/design/controller.py", '"23": "USB_DM"', '"23": "USB_DP"')
    board.edit("hw/kicad/design/controller.py", '"24": "USB_DP"', '"24": "USB_DM"')
    board.draw()
    verdict = board.make("hw")
    assert verdict.status != 0
    assert "net USB_DM" in verdict.output
    assert verdict.failed("drc")
    assert verdict.failed("nets")


def test_a_missing_free_wheel_diode_is_found(board: Board) -> None:
    board.edit(
        "hw/kicad/design/motor.py",
        '    sheet.wire(f"{transistor}.2", (162, row - 4)',
        "    if phase == 1:\n        sheet.parts.pop()\n        return\n"
        '    sheet.wire(f"{transistor}.2", (162, row - 4)',
    )
    board.draw()
    verdict = board.check("nets", "drc")
    assert verdict.failed("nets")
    assert verdict.failed("drc")
    assert "D71" in verdict.output


def test_a_wire_on_the_wrong_pin_of_the_chip_is_found(board: Board) -> None:
    board.edit("hw/kicad/design/controller.py", '"37": "LIMIT_X"', '"37": "LIMIT_Z"')
    board.edit("hw/kicad/design/controller.py", '"38": "LIMIT_Z"', '"38": "LIMIT_X"')
    board.draw()
    verdict = board.check("nets")
    assert "board.h has LIMIT_X on RB4, pin 37; the board has LIMIT_Z there" in verdict.output


def test_a_pin_moved_in_the_firmware_alone_is_found(board: Board) -> None:
    board.edit("firmware/board.h", "BOARD_PIN(COIL_X1, D, 0)", "BOARD_PIN(COIL_X1, D, 1)")
    verdict = board.check("nets")
    assert verdict.failed("nets")
    assert "COIL_X1" in verdict.output


def test_a_firmware_without_pin_table_is_found(board: Board) -> None:
    board.edit("firmware/board.h", "BOARD_PIN(", "OTHER_PIN(")
    assert "board.h has no BOARD_PIN lines" in board.check("nets").output


def test_a_widened_track_is_found(board: Board) -> None:
    text = board.read(f"{PROJECT}.kicad_pcb")
    tracks = re.findall(r"\(segment\s+\(start [^)]*\)\s+\(end [^)]*\)\s+\(width 0\.3\)", text)
    board.edit(f"{PROJECT}.kicad_pcb", tracks[0], tracks[0].replace("(width 0.3)", "(width 3)"))
    verdict = board.check("drc")
    assert verdict.failed("drc")


def test_a_thinned_winding_track_is_found(board: Board) -> None:
    board.edit(f"{PROJECT}.kicad_pcb", "(width 1.6)", "(width 0.5)")
    verdict = board.check("drc")
    assert "track_width" in verdict.output


def test_copper_in_the_isolation_gap_is_found(board: Board) -> None:
    net = re.search(r'\(net (\d+) "GND"\)', board.read(f"{PROJECT}.kicad_pcb"))
    assert net is not None
    board.edit(
        f"{PROJECT}.kicad_pcb",
        "\t(segment",
        '\t(segment (start 139 89) (end 143 89) (width 0.3) (layer "F.Cu") '
        f'(net {net[1]}) (uuid "00000000-0000-0000-0000-000000000001"))\n\t(segment',
        count=1,
    )
    verdict = board.check("drc")
    assert "isolation gap" in verdict.output


def test_a_changed_value_is_found(board: Board) -> None:
    board.edit("hw/kicad/design/motor.py", '"330", (34, row)', '"33", (34, row)')
    board.draw()
    verdict = board.check("nets", "drc")
    assert "R21 is '33', the table says '330'" in verdict.output
    assert verdict.failed("drc")


def test_a_schematic_edited_past_its_script_is_found(board: Board) -> None:
    board.edit("hw/kicad/panel.kicad_sch", '"Panel connector"', '"Panel plug"')
    verdict = board.check("generated")
    assert "panel.kicad_sch is not what the scripts write" in verdict.output


def test_a_loose_wire_is_found(board: Board) -> None:
    board.edit("hw/kicad/design/power.py", '    sheet.wire("Q4.3", (106, 64))\n', "")
    board.draw()
    assert board.check("erc").failed("erc")


def test_texts_on_each_other_stop_the_drawing(board: Board) -> None:
    board.edit(
        "hw/kicad/design/panel.py", '"Panel connector", (94, 96)', '"Panel connector", (112, 112)'
    )
    verdict = board.check("generated")
    assert "Panel connector" in verdict.output


def test_a_clamp_too_high_for_the_transistor_is_found(board: Board) -> None:
    board.edit("hw/spice/winding.cir", "vz=18", "vz=45")
    verdict = board.check("spice")
    assert "drain above 50 V" in verdict.output
