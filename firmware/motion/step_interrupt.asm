; Step interrupt: takes the next entry of the step stream, writes the coils,
; counts the step, sets the time of the next one.
; SPDX-License-Identifier: Apache-2.0
;
; High priority, entered by CCP2 comparing with the free-running Timer 1
; (12 MHz), so a step happens a fixed number of cycles after its time and
; errors never add up. The order below is what keeps it exact:
;
;       time reached -> write the coil patterns prepared last time
;                    -> count that step
;                    -> take the next entry, prepare its patterns
;                    -> add its interval to the compare register
;
; Entry of the step ring, two bytes (see stream.h for the meaning):
;       flags    bit 0 X step, 1 X is negative, 2 Z step, 3 Z is negative,
;                4 X takes up slack, 5 Z takes up slack, 6 new speed, 7 end
;       stretch  path length of the step less one, in 1/256
; interval = period + (stretch * period) / 256, in cycles, 24 bits.
;
; Intervals over 65,535 cycles are cut: while 0x10000 or more remain, half a
; turn of Timer 1 (0x8000) is waited for first, so that the last piece is
; never shorter than half a turn. The compare register is written high byte
; first: the intermediate value can then only match if this interrupt had
; taken 256 cycles, and it never takes half of that.

        include <p18f4550.inc>
        radix   dec

        global  _stream_head, _stream_tail, _stream_flags
        global  _speed_head, _speed_tail, _speed_ring, _stream_mark
        global  _position_x, _position_z, _slack_x, _slack_z
        global  _phase_x, _phase_z, _phase_step, _coils_x, _coils_z
        global  _pattern_x, _pattern_z, _stream_next, _step_ring

STEP_X          equ     0
X_NEGATIVE      equ     1
STEP_Z          equ     2
Z_NEGATIVE      equ     3
SLACK_X         equ     4
SLACK_Z         equ     5
NEW_SPEED       equ     6
END_ENTRY       equ     7

; _stream_flags
ACTIVE          equ     0               ; an interrupt is due
WAITING         equ     1               ; half turns of the timer remain
DRY             equ     2               ; ring was empty in mid-move

access_data     udata_acs
_stream_head    res 1                   ; written by the main loop only
_stream_tail    res 1                   ; written here only
_stream_flags   res 1
_stream_next    res 1                   ; flags of the step to come
_stream_mark    res 1                   ; mark of the speed in force
_speed_head     res 1                   ; offset into _speed_ring, 0..31
_speed_tail     res 1
_pattern_x      res 1                   ; coils to write at the next step
_pattern_z      res 1
_phase_x        res 1                   ; index into the coil table, 0..7
_phase_z        res 1
_phase_step     res 1                   ; 2 = full or wave step, 1 = half
_position_x     res 2                   ; tool, machine steps
_position_z     res 2
_slack_x        res 2                   ; screw less tool, steps
_slack_z        res 2
stretch         res 1
period          res 3
remain          res 3                   ; cycles still to be scheduled
save_fsr0       res 2

; Tables reached through FSR0 with FSR0H = 0: the linker script keeps them in
; bank 0, above the access bank.
step_tables     udata
_coils_x        res 8                   ; patterns in forward order, or
_coils_z        res 8                   ; backward for an inverted axis
_speed_ring     res 32                  ; 8 x (period, 24 bits; mark)

step_ring       udata
_step_ring      res 256

vector_high     code    0x000008
        goto    step_interrupt

count_up        macro   counter
        infsnz  counter, F, A
        incf    counter + 1, F, A
        endm

count_down      macro   counter
        movlw   0xFF
        addwf   counter, F, A
        addwfc  counter + 1, F, A
        endm

; Counts the step just made on one axis, in the tool's or the slack's counter.
account macro   step, negative, slack, position, slack_counter
        local   is_slack, down, slack_down, done
        btfss   _stream_next, step, A
        bra     done
        btfsc   _stream_next, slack, A
        bra     is_slack
        btfsc   _stream_next, negative, A
        bra     down
        count_up position
        bra     done
down:   count_down position
        bra     done
is_slack:
        btfsc   _stream_next, negative, A
        bra     slack_down
        count_up slack_counter
        bra     done
slack_down:
        count_down slack_counter
done:
        endm

; Turns one motor's phase by a step and looks its pattern up (FSR0H = 0).
advance macro   step, negative, phase, table, pattern
        local   minus, look_up, done
        btfss   _stream_next, step, A
        bra     done
        movf    _phase_step, W, A
        btfsc   _stream_next, negative, A
        bra     minus
        addwf   phase, W, A
        bra     look_up
minus:  subwf   phase, W, A
look_up:
        andlw   7
        movwf   phase, A
        addlw   LOW(table)
        movwf   FSR0L, A
        movff   INDF0, pattern
done:
        endm

code_step       code
step_interrupt:
        bcf     PIR2, CCP2IF, A
        btfsc   _stream_flags, WAITING, A
        bra     schedule
        movff   _pattern_z, LATB
        movff   _pattern_x, LATD
        account STEP_X, X_NEGATIVE, SLACK_X, _position_x, _slack_x
        account STEP_Z, Z_NEGATIVE, SLACK_Z, _position_z, _slack_z

        btfsc   _stream_next, END_ENTRY, A
        bra     stop
        movf    _stream_tail, W, A
        cpfseq  _stream_head, A
        bra     take
        bsf     _stream_flags, DRY, A
stop:
        bcf     PIE2, CCP2IE, A
        bcf     _stream_flags, ACTIVE, A
        clrf    _stream_next, A
        retfie  FAST

take:
        movff   FSR0L, save_fsr0
        movff   FSR0H, save_fsr0 + 1
        movwf   FSR0L, A
        movlw   HIGH(_step_ring)
        movwf   FSR0H, A
        movff   POSTINC0, _stream_next
        movff   INDF0, stretch
        movlw   2
        addwf   _stream_tail, F, A
        clrf    FSR0H, A
        btfss   _stream_next, NEW_SPEED, A
        bra     patterns
        movf    _speed_tail, W, A
        addlw   LOW(_speed_ring)
        movwf   FSR0L, A
        movff   POSTINC0, period
        movff   POSTINC0, period + 1
        movff   POSTINC0, period + 2
        movff   INDF0, _stream_mark
        movlw   4
        addwf   _speed_tail, W, A
        andlw   0x1F
        movwf   _speed_tail, A

patterns:
        advance STEP_X, X_NEGATIVE, _phase_x, _coils_x, _pattern_x
        advance STEP_Z, Z_NEGATIVE, _phase_z, _coils_z, _pattern_z
        movff   save_fsr0 + 1, FSR0H
        movff   save_fsr0, FSR0L

        movff   period, remain
        movff   period + 1, remain + 1
        movff   period + 2, remain + 2
        movf    stretch, W, A
        bz      schedule
        ; PROD belongs to the program interrupted here
        movff   PRODL, save_fsr0
        movff   PRODH, save_fsr0 + 1
        mulwf   period + 1, A
        movf    PRODL, W, A
        addwf   remain, F, A
        movf    PRODH, W, A
        addwfc  remain + 1, F, A
        movlw   0
        addwfc  remain + 2, F, A
        movf    stretch, W, A
        mulwf   period + 2, A
        movf    PRODL, W, A
        addwf   remain + 1, F, A
        movf    PRODH, W, A
        addwfc  remain + 2, F, A
        movf    stretch, W, A
        mulwf   period, A
        movf    PRODH, W, A
        addwf   remain, F, A
        movlw   0
        addwfc  remain + 1, F, A
        addwfc  remain + 2, F, A
        movff   save_fsr0 + 1, PRODH
        movff   save_fsr0, PRODL

schedule:
        movf    remain + 2, W, A
        bnz     half_turn
        bcf     _stream_flags, WAITING, A
        movf    remain, W, A
        addwf   CCPR2L, W, A
        movwf   remain, A
        movf    remain + 1, W, A
        addwfc  CCPR2H, W, A
        movwf   CCPR2H, A
        movff   remain, CCPR2L
        retfie  FAST

half_turn:
        bsf     _stream_flags, WAITING, A
        btg     CCPR2H, 7, A
        movlw   0x80
        subwf   remain + 1, F, A
        movlw   0
        subwfb  remain + 2, F, A
        retfie  FAST
        end
