; Ramp: the speed along the path. See ramp.h.
; SPDX-License-Identifier: Apache-2.0
;
; Runs in the low-priority interrupt, hence without library calls, and in
; assembly because 24-bit numbers suit it: 300 cycles at constant speed, 1,150
; while the speed changes.
;
; The step interrupt asks for it when it takes an entry with a new period, and
; leaves the state at that entry in _ramp_count and _ramp_stretch. What follows
; from it, the next speed and the entry that takes it (_ramp_at), depends on
; nothing else, and so not on when this runs, if it is done before that entry
; comes: half a millisecond or more.

        include <p18f4550.inc>
        radix   dec

        global  _ramp_tick, _ramp_arm
        global  wanted, remainder, bits, square, product
        global  _ramp_speed, _ramp_start, _ramp_top, _ramp_step, _ramp_scale
        global  _ramp_way, _stream_period, _ramp_count, _ramp_stretch
        global  _ramp_flags, _ramp_segment, _ramp_stop
        global  _ramp_brake_speed, _ramp_brake_factor, _ramp_brake_distance

        extern  _ramp_set_period, ramp_multiply, _ramp_brake
        extern  _segments, _segment_speed, _path_made, _path_head, _path_mark
        extern  _stream_flags, _stream_count, _stream_tail
        extern  _ramp_at

; struct segment of path.h
SEGMENTS        equ     16
SEGMENT_SIZE    equ     22
AT_KIND         equ     12
AT_MARK         equ     13
AT_END          equ     16
AT_ENTRY        equ     18
RAPID           equ     7               ; bit of the kind

; _ramp_flags
RUNNING         equ     0
HOLDING         equ     1
HELD            equ     2
CHANGED         equ     3               ; the speed, in this run

; _stream_flags
ACTIVE          equ     0
STOOD           equ     3

ramp_data       udata
_stream_period  res 3                   ; the next period; the division needs
_ramp_stretch   res 1                   ; a fourth byte: stretch of the entry
_ramp_count     res 1                   ; that took it, low byte of the count
_ramp_speed     res 4                   ; 1/256 step/s, 24 bits used
_ramp_start     res 4                   ; start/stop speed
_ramp_top       res 4                   ; no override goes beyond
_ramp_step      res 2                   ; change in 1/1024 s
_ramp_stop      res 2                   ; braking distance from the start speed
_ramp_flags     res 1
_ramp_segment   res 1
_ramp_way       res 2                   ; not yet ticked for, 1/1024 entry
wanted          res 4                   ; 24 bits used
next            res 3
least           res 3
square
made            res 2
left            res 2
limit           res 2
entries                                 ; 4 times those to the next speed
kind            res 1
product
remainder       res 4
bits            res 1
_ramp_brake_speed res 2                 ; step/s
_ramp_brake_factor res 2                ; 2^24 / acceleration
_ramp_brake_distance res 2              ; 1/2 step, at most 65,535
_ramp_scale     res 2                   ; override, 256 = 100 %

ramp_code       code

; --- once with every new period ----------------------------------------------
copy_3  macro   from, to
        movff   from, to
        movff   from + 1, to + 1
        movff   from + 2, to + 2
        endm

; Carry set when a >= b.
compare macro   a, b
        movf    b, W, B
        subwf   a, W, B
        movf    b + 1, W, B
        subwfb  a + 1, W, B
        movf    b + 2, W, B
        subwfb  a + 2, W, B
        endm

; FSR0 to the segment with the index in W.
point:
        mullw   SEGMENT_SIZE
        lfsr    0, _segments
        movf    PRODL, W, A
        addwf   FSR0L, F, A
        movf    PRODH, W, A
        addwfc  FSR0H, F, A
        return

; W := index after the present segment.
following:
        incf    _ramp_segment, W, B
        xorlw   SEGMENTS
        btfss   STATUS, Z, A
        xorlw   SEGMENTS
        return

_ramp_tick:
        banksel _ramp_flags
        movf    _ramp_flags, W, B
        andlw   (1 << RUNNING) | (1 << HELD)
        xorlw   1 << RUNNING
        btfsc   STATUS, Z, A
        btfss   _stream_flags, ACTIVE, A
        return
read_count:
        movff   _stream_count, made
        movff   _stream_count + 1, made + 1
        movf    made, W, B
        xorwf   _stream_count, W, A
        bnz     read_count
        movf    _ramp_count, W, B
        subwf   made, W, B
        btfss   STATUS, C, A
        decf    made + 1, F, B
        movff   _ramp_count, made

; The segment being executed, and the entries left in it.
this_segment:
        movf    _ramp_segment, W, B
        rcall   point
        movlw   AT_END
        movff   PLUSW0, left
        movlw   AT_END + 1
        movff   PLUSW0, left + 1
        movf    made, W, B
        subwf   left, F, B
        movf    made + 1, W, B
        subwfb  left + 1, F, B
        movff   _path_made, WREG
        xorwf   _ramp_segment, W, B
        bz      segment_found
        btfsc   left + 1, 7, B
        bra     segment_over
        movf    left, W, B
        iorwf   left + 1, W, B
        bnz     segment_found
segment_over:
        rcall   following
        movwf   _ramp_segment, B
        bra     this_segment
segment_found:
        movlw   AT_KIND
        movff   PLUSW0, kind
        movlw   AT_MARK
        movff   PLUSW0, _path_mark

; The speed wanted in it.
        movf    _ramp_segment, W, B
        mullw   4
        lfsr    0, _segment_speed
        movf    PRODL, W, A
        addwf   FSR0L, F, A
        movlw   0
        addwfc  FSR0H, F, A
        movff   POSTINC0, wanted
        movff   POSTINC0, wanted + 1
        movff   POSTINC0, wanted + 2
        decf    _ramp_scale + 1, W, B   ; 256 = 100 %
        iorwf   _ramp_scale, W, B
        bz      as_programmed
        btfsc   kind, RAPID, B
        bra     as_programmed
        call    ramp_multiply
        compare wanted, _ramp_top
        bnc     as_programmed
        copy_3  _ramp_top, wanted
as_programmed:

; How far the tool may still brake: to the end of the segment, and what may be
; left there.
        movff   _ramp_stop, limit
        movff   _ramp_stop + 1, limit + 1
        rcall   following
        movff   _path_head, kind
        xorwf   kind, W, B
        bz      last_segment
        xorwf   kind, W, B
        rcall   point
        movlw   AT_ENTRY
        movff   PLUSW0, limit
        movlw   AT_ENTRY + 1
        movff   PLUSW0, limit + 1
last_segment:
        btfsc   left + 1, 7, B
        bra     choose
        bcf     STATUS, C, A
        rlcf    left, F, B
        rlcf    left + 1, F, B
; Some of it is lost: this speed's entries and those of the next, twice the
; speed / 1024 + 1.
        movlw   4
        addwf   _ramp_speed + 2, W, B
        subwf   left, F, B
        movlw   0
        subwfb  left + 1, F, B
        bc      add_way
        clrf    left, B
        clrf    left + 1, B
add_way:
        movf    left, W, B
        addwf   limit, F, B
        movf    left + 1, W, B
        addwfc  limit + 1, F, B
        bnc     choose
        setf    limit, B
        setf    limit + 1, B

choose:
        btfss   _ramp_flags, HOLDING, B
        bra     entries_to_go
        copy_3  _ramp_start, wanted
        compare _ramp_start, _ramp_speed
        bnc     entries_to_go
        bcf     PIE2, CCP2IE, A         ; slow enough to stand
        bsf     _ramp_flags, HELD, B
        return

; The entries that go by at this speed: speed / 1024 + 1, a millisecond or two,
; or one that lasts longer. Their way at it takes so many 1/1024 s, and every
; one of these changes the speed that comes next.
entries_to_go:
        movlw   0xFC
        andwf   _ramp_speed + 2, W, B
        addlw   4
        movwf   entries, B
        addwf   _ramp_way + 1, F, B
        mulwf   _ramp_stretch, B
        movf    PRODL, W, A
        addwf   _ramp_way, F, B
        movf    PRODH, W, A
        addwfc  _ramp_way + 1, F, B
        bcf     _ramp_flags, CHANGED, B
        btfsc   _stream_flags, STOOD, A
        bra     no_time                 ; a ramp begins with the second step
time:
        movf    _ramp_speed + 1, W, B
        subwf   _ramp_way, W, B
        movf    _ramp_speed + 2, W, B
        subwfb  _ramp_way + 1, W, B
        bnc     time_over
        movf    _ramp_speed + 1, W, B
        subwf   _ramp_way, F, B
        movf    _ramp_speed + 2, W, B
        subwfb  _ramp_way + 1, F, B
        rcall   least_speed
        iorlw   0
        bnz     time                    ; 0: the speed stays as it is
no_time:
        bcf     _stream_flags, STOOD, A
        clrf    _ramp_way, B
        clrf    _ramp_way + 1, B
time_over:
        btfss   _ramp_flags, CHANGED, B
        bra     same_period
        call    _ramp_set_period
same_period:
        bcf     STATUS, C, A
        rrcf    entries, W, B
        addwf   _ramp_at, F, A
        bra     armed

; The next entry takes the period.
_ramp_arm:
        movlw   2
        addwf   _stream_tail, W, A
        movwf   _ramp_at, A
armed:
        movf    _stream_tail, W, A
        subwf   _ramp_at, W, A
        bz      _ramp_arm               ; it has been taken meanwhile
        bn      _ramp_arm
        return

; The speed 1/1024 s later. Returns W = 0 when it stays.
least_speed:
        copy_3  _ramp_start, least
        compare wanted, least
        bc      try_brakes
        copy_3  wanted, least
try_brakes:
        copy_3  _ramp_speed, next
        compare _ramp_start, _ramp_speed
        bc      no_need                 ; it may change at once
        rcall   too_fast
        bc      slower                  ; towards least
no_need:
        compare _ramp_speed, wanted
        bc      not_below
        movf    _ramp_step, W, B
        addwf   next, F, B
        movf    _ramp_step + 1, W, B
        addwfc  next + 1, F, B
        movlw   0
        addwfc  next + 2, F, B
        compare next, wanted
        bnc     faster
        copy_3  wanted, next
faster:
        compare _ramp_start, next
        bc      take_speed
        rcall   too_fast
        bnc     take_speed
        retlw   0
not_below:
        compare wanted, _ramp_speed
        btfsc   STATUS, C, A
        retlw   0                       ; just right
        copy_3  wanted, least
        compare _ramp_start, _ramp_speed
        bc      to_least                ; so slow that it may change at once
slower:
        movf    _ramp_step, W, B
        subwf   next, F, B
        movf    _ramp_step + 1, W, B
        subwfb  next + 1, F, B
        movlw   0
        subwfb  next + 2, F, B
        bnc     to_least
        compare next, least
        bc      take_speed
to_least:
        copy_3  least, next
take_speed:
        copy_3  next, _ramp_speed
        bsf     _ramp_flags, CHANGED, B
        retlw   1

; Carry set when the way in limit is too short to brake from the speed in next.
too_fast:
        movff   next + 1, _ramp_brake_speed
        movff   next + 2, _ramp_brake_speed + 1
        call    _ramp_brake
        movf    _ramp_brake_distance, W, B
        subwf   limit, W, B
        movf    _ramp_brake_distance + 1, W, B
        subwfb  limit + 1, W, B
        btg     STATUS, C, A
        return
        end
