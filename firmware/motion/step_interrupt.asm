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
;                4 X takes up slack, 5 Z takes up slack, 6 advances the path,
;                7 no step but an order: bits 0..1 say which
;       stretch  path length of the step less one, in 1/256; of an order its
;                number
; interval = period + (stretch * period) / 256, in cycles, 24 bits; of a wait
; the number of milliseconds that its entry tells.
;
; The period changes with certain entries only, each named by the place in the
; ring behind it, _ramp_at: so which step gets which speed does not depend on
; when the ramp finds time to work out the next one. It is woken there, by the
; flag of Timer 3, which stands still.
;
; Intervals over 65,535 cycles are cut: while 0x10000 or more remain, half a
; turn of Timer 1 (0x8000) is waited for first, so that the last piece is
; never shorter than half a turn. The compare register is written high byte
; first: the intermediate value can then only match if this interrupt had
; taken 256 cycles, and it never takes half of that.

        include <p18f4550.inc>
        radix   dec

        global  _stream_head, _stream_tail, _stream_flags
        global  _stream_count, _stream_signal
        global  _stream_step_dir, _stream_pulse, _stream_invert_x
        global  _stream_invert_z, _ramp_at
        global  _position_x, _position_z, _slack_x, _slack_z
        global  _phase_x, _phase_z, _phase_step, _coils_x, _coils_z
        global  _pattern_x, _pattern_z, _stream_next, _step_ring
        extern  _stream_period, _ramp_count, _ramp_stretch ; ramp_tick.asm

STEP_X          equ     0
X_NEGATIVE      equ     1
STEP_Z          equ     2
Z_NEGATIVE      equ     3
SLACK_X         equ     4
SLACK_Z         equ     5
ADVANCES        equ     6
ORDER           equ     7
; Orders, bits 0..1
ORDER_END       equ     0
CYCLES_PER_MS   equ     12000
NO_INTERVAL     equ     240             ; 20 us: longer than this interrupt
ORDER_WAIT      equ     1
ORDER_OUTPUT    equ     2
ORDER_SIGNAL    equ     3

; _stream_flags
ACTIVE          equ     0               ; an interrupt is due
WAITING         equ     1               ; half turns of the timer remain
DRY             equ     2               ; ring was empty in mid-move
STOOD           equ     3               ; before the entry to come

access_data     udata_acs
_stream_head    res 1                   ; written by the main loop only
_stream_tail    res 1                   ; written here only
_stream_flags   res 1
_stream_next    res 1                   ; flags of the step to come
_stream_count   res 2                   ; entries that advanced the path
_stream_signal  res 1                   ; number of the last signal passed
_ramp_at        res 1                   ; tail behind the entry that takes the
                                        ; next period
_stream_step_dir res 1                  ; bit 0: pulses instead of coils
_stream_pulse   res 1                   ; longer pulse, in 1/4 us
_stream_invert_x res 1                  ; 2 = direction output inverted
_stream_invert_z res 1
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

step_ring       udata
_step_ring      res 256

count_up        macro   counter
        infsnz  counter, F, A
        incf    counter + 1, F, A
        endm

count_down      macro   counter
        movlw   0xFF
        addwf   counter, F, A
        addwfc  counter + 1, F, A
        endm

; Counts the step just made on one axis, in the tool's or the slack's counter;
; the tool's takes 10 cycles either way, the slack's 12, behind the interrupt.
account macro   step, negative, slack, position, is_slack, done
        local   down
        btfss   _stream_next, step, A
        bra     done
        btfsc   _stream_next, slack, A
        bra     is_slack
        btfsc   _stream_next, negative, A
        bra     down
        count_up position
        bra     done
down:   count_down position
done:
        endm

account_slack macro negative, counter, is_slack, done
        local   up
is_slack:
        btfss   _stream_next, negative, A
        bra     up
        count_down counter
        bra     done
up:     count_up counter
        bra     done
        endm

; Turns one motor's phase by a step and looks its pattern up (FSR0H = 0).
advance macro   step, negative, phase, table, pattern
        local   done
        btfss   _stream_next, step, A
        bra     done
        movf    _phase_step, W, A
        btfsc   _stream_next, negative, A
        sublw   0
        addwf   phase, W, A
        andlw   7
        movwf   phase, A
        addlw   LOW(table)
        movwf   FSR0L, A
        movff   INDF0, pattern
done:
        endm

; The loader's vector leads here (loader/loader.inc).
code_step       code    0x000820
step_interrupt:
        bcf     PIR2, CCP2IF, A
        btfsc   _stream_flags, WAITING, A
        bra     waited
        movff   _pattern_z, LATB
        movff   _pattern_x, LATD
        btfsc   _stream_next, ORDER, A
        bra     order
        account STEP_X, X_NEGATIVE, SLACK_X, _position_x, is_slack_x, done_x
        account STEP_Z, Z_NEGATIVE, SLACK_Z, _position_z, is_slack_z, done_z

        btfss   _stream_next, ADVANCES, A
        bra     next
        infsnz  _stream_count, F, A
        incf    _stream_count + 1, F, A
next:
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
        movff   POSTINC0, stretch
        movf    FSR0L, W, A
        movwf   _stream_tail, A
        clrf    FSR0H, A
        btfsc   _stream_next, ORDER, A
        bra     order_interval
        cpfseq  _ramp_at, A
        bra     patterns
        movff   _stream_period, period
        movff   _stream_period + 1, period + 1
        movff   _stream_period + 2, period + 2
        movff   _stream_count, _ramp_count
        movff   stretch, _ramp_stretch
        bsf     PIR2, TMR3IF, A
patterns:
        btfsc   _stream_step_dir, 0, A
        bra     pulses
        advance STEP_X, X_NEGATIVE, _phase_x, _coils_x, _pattern_x
        advance STEP_Z, Z_NEGATIVE, _phase_z, _coils_z, _pattern_z
patterns_known:
        movff   save_fsr0 + 1, FSR0H
        movff   save_fsr0, FSR0L
        movf    stretch, W, A
        bz      straight
        ; PROD belongs to the program interrupted here
        movff   PRODL, save_fsr0
        movff   PRODH, save_fsr0 + 1
        mulwf   period + 1, A
        movf    PRODL, W, A
        addwf   period, W, A
        movwf   remain, A
        movf    PRODH, W, A
        addwfc  period + 1, W, A
        movwf   remain + 1, A
        movlw   0
        addwfc  period + 2, W, A
        movwf   remain + 2, A
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
        movf    remain, W, A
        addwf   CCPR2L, W, A
        movwf   remain, A
        movf    remain + 1, W, A
        addwfc  CCPR2H, W, A
        movwf   CCPR2H, A
        movff   remain, CCPR2L
        retfie  FAST

straight:
        movff   period, remain
        movff   period + 1, remain + 1
        movff   period + 2, remain + 2
        bra     schedule

        account_slack X_NEGATIVE, _slack_x, is_slack_x, done_x
        account_slack Z_NEGATIVE, _slack_z, is_slack_z, done_z

waited:
        bcf     _stream_flags, WAITING, A
        bra     schedule
half_turn:
        bsf     _stream_flags, WAITING, A
        btg     CCPR2H, 7, A
        movlw   0x80
        subwf   remain + 1, F, A
        movlw   0
        subwfb  remain + 2, F, A
        retfie  FAST

; Step and direction outputs: bit 0 step, 1 direction, 2 enable. The step
; just made is ended here, at least 5 us after its edge; the direction of the
; next one stands from here on, a whole interval ahead of it.
pulse   macro   step, negative, invert, pattern
        movlw   4
        btfsc   _stream_next, negative, A
        movlw   6
        xorwf   invert, W, A
        btfsc   _stream_next, step, A
        iorlw   1
        movwf   pattern, A
        endm

pulses:
        pulse   STEP_X, X_NEGATIVE, _stream_invert_x, _pattern_x
        pulse   STEP_Z, Z_NEGATIVE, _stream_invert_z, _pattern_z
        movf    _stream_pulse, W, A
pulse_wait:
        addlw   -1
        bc      pulse_wait
        movf    _pattern_x, W, A
        andlw   6
        movwf   LATD, A
        movf    _pattern_z, W, A
        andlw   6
        movwf   LATB, A
        bra     patterns_known

; Interval before an order: none for most (as short as can be), for a wait
; its milliseconds: stretch * 12,000. It has no speed; one that was meant for
; it waits for the entry behind.
order_interval:
        movff   save_fsr0 + 1, FSR0H
        movff   save_fsr0, FSR0L
        xorwf   _ramp_at, W, A          ; W is the tail
        movlw   2
        btfsc   STATUS, Z, A
        addwf   _ramp_at, F, A
        clrf    remain + 2, A
        clrf    remain + 1, A
        movlw   NO_INTERVAL
        movwf   remain, A
        movf    _stream_next, W, A
        andlw   3
        xorlw   ORDER_WAIT
        bz      wait_interval
        bra     schedule
wait_interval:
        bsf     _stream_flags, STOOD, A
        movff   PRODL, save_fsr0
        movff   PRODH, save_fsr0 + 1
        movf    stretch, W, A
        mullw   LOW(CYCLES_PER_MS)
        movff   PRODL, remain
        movff   PRODH, remain + 1
        movf    stretch, W, A
        mullw   HIGH(CYCLES_PER_MS)
        movf    PRODL, W, A
        addwf   remain + 1, F, A
        movlw   0
        addwfc  PRODH, W, A
        movwf   remain + 2, A
        movff   save_fsr0 + 1, PRODH
        movff   save_fsr0, PRODL
        bra     schedule

; The time of an order has come.
order:
        movf    _stream_next, W, A
        andlw   3
        bnz     not_end
        bra     stop
not_end:
        xorlw   ORDER_SIGNAL
        bnz     not_signal
        movff   stretch, _stream_signal
        bra     next
not_signal:
        xorlw   ORDER_SIGNAL ^ ORDER_OUTPUT
        bz      output
        bra     next                    ; a wait: its time was its purpose
output:
        movf    stretch, W, A           ; RC6 spindle, RC7 coolant, both at
        xorwf   LATC, W, A              ; once and none twice
        andlw   0xC0
        xorwf   LATC, F, A
        bra     next
        end
