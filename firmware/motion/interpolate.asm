; Interpolation of lines and arcs: see interpolate.h.
; SPDX-License-Identifier: Apache-2.0

        include <p18f4550.inc>
        radix   dec

        global  _run_straight, _run_diagonal, _run_batch, _run_head
        global  _run_stretch, _run_error, _run_major, _run_minor
        global  _run_change_major, _run_change_minor, _run_decision
        global  _run_curve, _run_sine, _run_sine_step
        global  _interpolate_line, _interpolate_arc, _interpolate_stretch
        extern  _step_ring

interpolate_data udata
_run_straight   res 1
_run_diagonal   res 1
_run_batch      res 1
_run_head       res 1
_run_stretch    res 1
_run_error      res 2
_run_major      res 2
_run_minor      res 2
_run_change_major res 4
_run_change_minor res 4
_run_decision   res 4
_run_curve      res 2
_run_sine       res 4
_run_sine_step  res 4

interpolate_code code

; FSR0 to the next free entry; the bank of the run is selected.
begin   macro
        banksel _run_head
        movff   _run_head, FSR0L
        movlw   HIGH(_step_ring)
        movwf   FSR0H, A
        endm

; Behind the last byte of the ring comes its first.
wrap    macro
        movlw   HIGH(_step_ring)
        movwf   FSR0H, A
        endm

add16   macro   to, what
        movf    what, W, B
        addwf   to, F, B
        movf    what + 1, W, B
        addwfc  to + 1, F, B
        endm

add32   macro   to, what
        add16   to, what
        movf    what + 2, W, B
        addwfc  to + 2, F, B
        movf    what + 3, W, B
        addwfc  to + 3, F, B
        endm

; Adds 256 * _run_curve, sign extended, to 32 bits.
curve   macro   to
        movf    _run_curve, W, B
        addwf   to + 1, F, B
        movf    _run_curve + 1, W, B
        addwfc  to + 2, F, B
        addwfc  to + 3, F, B
        endm

_interpolate_line:
        begin
line_entry:
        movf    _run_minor, W, B
        subwf   _run_error, F, B
        movf    _run_minor + 1, W, B
        subwfb  _run_error + 1, F, B
        bc      line_straight
        add16   _run_error, _run_major
        movff   _run_diagonal, POSTINC0
        bra     line_put
line_straight:
        movff   _run_straight, POSTINC0
line_put:
        movff   _run_stretch, POSTINC0
        wrap
        decfsz  _run_batch, F, B
        bra     line_entry
        movff   FSR0L, _run_head
        return

_interpolate_arc:
        begin
        movlw   HIGH(sine_table)
        movwf   TBLPTRH, A
arc_entry:
        curve   _run_change_major
        btfsc   _run_decision + 3, 7, B
        bra     arc_straight
        curve   _run_change_minor
        add32   _run_decision, _run_change_major
        add32   _run_decision, _run_change_minor
        movff   _run_diagonal, POSTINC0
        bra     arc_put
arc_straight:
        add32   _run_decision, _run_change_major
        movff   _run_straight, POSTINC0
arc_put:
        add16   _run_sine, _run_sine_step
        movf    _run_sine_step + 2, W, B
        addwfc  _run_sine + 2, F, B
        movf    _run_sine + 2, W, B
        movwf   TBLPTRL, A
        tblrd*
        movff   TABLAT, POSTINC0
        wrap
        decfsz  _run_batch, F, B
        bra     arc_entry
        movff   FSR0L, _run_head
        return

_interpolate_stretch:
        banksel _run_head
        movlw   1
        movff   PLUSW1, TBLPTRL
        movlw   HIGH(slope_table)
        movwf   TBLPTRH, A
        tblrd*
        movf    TABLAT, W, A
        return

; 256 (sqrt(1 + (s / 256)^2) - 1), s = 0..255, and 256 (1 / sqrt(1 - ((s +
; 1/2) / 256)^2) - 1), each on a page of its own. A sine beyond the octant's
; reads as that of 45 degrees, one just below 0 as 0.

table_slope     code 0x007200
slope_table
        db      0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0
        db      0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1
        db      1, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2, 2
        db      3, 3, 3, 3, 3, 3, 3, 4, 4, 4, 4, 4
        db      4, 5, 5, 5, 5, 5, 6, 6, 6, 6, 6, 7
        db      7, 7, 7, 8, 8, 8, 8, 9, 9, 9, 9, 10
        db      10, 10, 10, 11, 11, 11, 12, 12, 12, 13, 13, 13
        db      13, 14, 14, 14, 15, 15, 15, 16, 16, 16, 17, 17
        db      17, 18, 18, 18, 19, 19, 20, 20, 20, 21, 21, 21
        db      22, 22, 23, 23, 23, 24, 24, 25, 25, 25, 26, 26
        db      27, 27, 28, 28, 28, 29, 29, 30, 30, 31, 31, 32
        db      32, 32, 33, 33, 34, 34, 35, 35, 36, 36, 37, 37
        db      38, 38, 39, 39, 40, 40, 41, 41, 42, 42, 43, 43
        db      44, 44, 45, 45, 46, 46, 47, 47, 48, 49, 49, 50
        db      50, 51, 51, 52, 52, 53, 54, 54, 55, 55, 56, 56
        db      57, 58, 58, 59, 59, 60, 60, 61, 62, 62, 63, 63
        db      64, 65, 65, 66, 66, 67, 68, 68, 69, 69, 70, 71
        db      71, 72, 73, 73, 74, 74, 75, 76, 76, 77, 78, 78
        db      79, 80, 80, 81, 82, 82, 83, 84, 84, 85, 85, 86
        db      87, 87, 88, 89, 89, 90, 91, 92, 92, 93, 94, 94
        db      95, 96, 96, 97, 98, 98, 99, 100, 100, 101, 102, 103
        db      103, 104, 105, 105

table_sine      code 0x007300
sine_table
        db      0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0
        db      0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1
        db      1, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2, 2
        db      3, 3, 3, 3, 3, 3, 4, 4, 4, 4, 4, 5
        db      5, 5, 5, 5, 6, 6, 6, 6, 6, 7, 7, 7
        db      7, 8, 8, 8, 9, 9, 9, 9, 10, 10, 10, 11
        db      11, 11, 12, 12, 12, 13, 13, 13, 14, 14, 14, 15
        db      15, 16, 16, 16, 17, 17, 18, 18, 19, 19, 19, 20
        db      20, 21, 21, 22, 22, 23, 23, 24, 24, 25, 26, 26
        db      27, 27, 28, 28, 29, 30, 30, 31, 31, 32, 33, 33
        db      34, 35, 36, 36, 37, 38, 38, 39, 40, 41, 42, 42
        db      43, 44, 45, 46, 47, 47, 48, 49, 50, 51, 52, 53
        db      54, 55, 56, 57, 58, 59, 60, 62, 63, 64, 65, 66
        db      67, 69, 70, 71, 73, 74, 75, 77, 78, 80, 81, 83
        db      84, 86, 87, 89, 90, 92, 94, 96, 97, 99, 101, 103
        db      105, 106, 106, 106, 106, 106, 106, 106, 106, 106, 106, 106
        db      106, 106, 106, 106, 106, 106, 106, 106, 106, 106, 106, 106
        db      106, 106, 106, 106, 106, 106, 106, 106, 106, 106, 106, 106
        db      106, 106, 106, 106, 106, 106, 106, 106, 106, 106, 106, 106
        db      106, 106, 106, 106, 0, 0, 0, 0, 0, 0, 0, 0
        db      0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0
        db      0, 0, 0, 0
        end
