; SPDX-License-Identifier: Apache-2.0
; Wakes the display, loads two custom characters, writes two lines, then shows
; the number of the key that is pressed (8: none) at the end of the second
; line. RAM 0x20: ADRESH, 0x21: the key, 0x22: times the display was set up.
; Everything is as quick as the data sheet allows: E high for 3 cycles, 6
; cycles from E to E, RS set one cycle before E.
;
; With a symbol defined (gpasm -D) it makes one mistake, see below.

    list p=18f4550
    include <p18f4550.inc>
    config FOSC=HSPLL_HS, PLLDIV=5, CPUDIV=OSC1_PLL2, WDT=OFF, LVP=OFF
    config PBADEN=OFF, XINST=OFF, MCLRE=ON

level   equ 0x20
key     equ 0x21
starts  equ 0x22
rs      equ 0x23
first   equ 0x24
second   equ 0x25
count   equ 0x26
count2  equ 0x27
before  equ 0x28
byte    equ 0x29

RS      equ 0
EN      equ 1
    ifndef POWER_US             ; 15,000 wanted
#define POWER_US .15100
    endif
    ifndef WAKE_1_US            ; 4,100
#define WAKE_1_US .4200
    endif
    ifndef WAKE_2_US            ; 100
#define WAKE_2_US .110
    endif
    ifndef INSTRUCTION_US       ; 37
#define INSTRUCTION_US .38
    endif
    ifndef DATA_US              ; 41
#define DATA_US .42
    endif
    ifndef CLEAR_US             ; 1,520
#define CLEAR_US .1600
    endif
    ifndef FUNCTION             ; two lines of 5x8 dots
#define FUNCTION 0x28
    endif
    ifndef WAKE_NIBBLE
#define WAKE_NIBBLE 3
    endif
    ifndef CONVERTER            ; 4 TAD to acquire, 64 TOSC, left justified
#define CONVERTER 0x16
    endif
    ifndef ANALOGUE             ; AN0 alone
#define ANALOGUE 0x0E
    endif
    ifndef DIRECTIONS           ; of port A: 0 = driven
#define DIRECTIONS 0x03
    endif

; Microseconds, up to 65,535: a little more than asked for.
wait_us macro us
    movlw low (us)
    movwf count, ACCESS
    movlw high (us) + 1
    movwf count2, ACCESS
    rcall wait
    endm

; A nibble with RS low, outside of any byte.
wake macro nibble
    movlw (nibble) << 2
    movwf LATA, ACCESS
    bsf LATE, EN, ACCESS
    nop
    nop
    bcf LATE, EN, ACCESS
    endm

    org 0
    movlw ANALOGUE
    movwf ADCON1, ACCESS
    movlw CONVERTER
    movwf ADCON2, ACCESS
    clrf LATA, ACCESS
    clrf LATE, ACCESS
    movlw DIRECTIONS
    movwf TRISA, ACCESS
    clrf TRISE, ACCESS
    wait_us POWER_US
    ifndef NO_WAKE
    wake 3
    wait_us WAKE_1_US
    wake WAKE_NIBBLE
    wait_us WAKE_2_US
    wake 3
    wait_us .50
    wake 2
    wait_us .50
    endif

; A table of (RS, byte), ended by 0xFF.
    clrf TBLPTRU, ACCESS
    movlw high table
    movwf TBLPTRH, ACCESS
    movlw low table
    movwf TBLPTRL, ACCESS
next
    tblrd*+
    movff TABLAT, rs
    incf rs, W, ACCESS
    bz keys
    tblrd*+
    movff TABLAT, byte
    rcall write
    bra next

; Reads the ladder for ever, every 5 ms.
keys
    incf starts, F, ACCESS
    setf before, ACCESS
    ifdef GO_WITH_ON
    movlw 0x03
    else
    movlw 0x01
    endif
    movwf ADCON0, ACCESS
again
    ifdef OTHER_CHANNEL         ; selected with no time to acquire
    movlw 0x05
    movwf ADCON0, ACCESS
    bcf ADCON2, ACQT1, ACCESS
    bcf ADCON0, CHS0, ACCESS
    endif
    bsf ADCON0, GO, ACCESS
    ifdef OTHER_CHANNEL_LATE
    bsf ADCON0, CHS0, ACCESS
    endif
    ifdef OTHER_SETTING         ; right justified in mid-conversion
    bsf ADCON2, ADFM, ACCESS
    endif
converting
    btfsc ADCON0, GO, ACCESS
    bra converting
    movff ADRESH, level
    movlw .16
    addwf level, W, ACCESS
    movwf key, ACCESS
    swapf key, F, ACCESS
    bc none
    rrncf key, W, ACCESS
    andlw 7
    bra have
none
    movlw 8
have
    movwf key, ACCESS
    cpfseq before, ACCESS
    bra show
    bra rest
show
    movwf before, ACCESS
    clrf rs, ACCESS
    movlw 0x80 + 0x4F
    movwf byte, ACCESS
    rcall write
    bsf rs, 0, ACCESS
    movlw '0'
    addwf key, W, ACCESS
    movwf byte, ACCESS
    rcall write
rest
    wait_us .5000
    bra again

; One byte, the upper half first.
write
    movf byte, W, ACCESS
    rcall half
    movwf second, ACCESS
    swapf byte, W, ACCESS
    rcall half
    movwf first, ACCESS
    ifdef LOWER_FIRST
    movff first, byte
    movff second, first
    movff byte, second
    endif
    movff first, LATA
    movf rs, W, ACCESS
    ifdef RS_WITH_E
    iorlw 1 << EN
    movwf LATE, ACCESS
    else
    movwf LATE, ACCESS
    bsf LATE, EN, ACCESS
    endif
    movf second, W, ACCESS
    ifndef SHORT_PULSE
    nop
    endif
    bcf LATE, EN, ACCESS
    movwf LATA, ACCESS
    ifndef FAST_PULSES
    nop
    endif
    bsf LATE, EN, ACCESS
    nop
    nop
    ifdef RS_DROPS
    clrf LATE, ACCESS
    else
    bcf LATE, EN, ACCESS
    endif
    btfsc rs, 0, ACCESS
    bra after_data
    movlw 0xFC
    andwf byte, W, ACCESS
    bz after_clear
    wait_us INSTRUCTION_US
    return
after_data
    wait_us DATA_US
    return
after_clear
    wait_us CLEAR_US
    return

; The lower half of W, where D4 to D7 are.
half
    andlw 0x0F
    rlncf WREG, W, ACCESS
    rlncf WREG, W, ACCESS
    return

; 12 cycles to a pass.
wait
    nop
    nop
    nop
    nop
    nop
    nop
    nop
    nop
    nop
    decfsz count, F, ACCESS
    bra wait
    nop
    decfsz count2, F, ACCESS
    bra wait
    return

table
    ifndef NO_FUNCTION
    db 0, FUNCTION
    endif
    ifdef TWO_FUNCTIONS
    db 0, 0x20
    endif
    db 0, 0x08                  ; display off
    ifndef NO_CLEAR
    db 0, 0x01
    endif
    ifndef NO_ENTRY
    db 0, 0x06
    endif
    ifdef NOTHING
    db 0, 0x00
    endif
    ifdef NO_ADDRESS
    db 0, 0x80 + 0x28
    endif
    db 0, 0x0C                  ; on, no cursor
    db 0, 0x40                  ; character 0: a acute
    db 1, 0x02, 1, 0x04, 1, 0x0E, 1, 0x01, 1, 0x0F, 1, 0x11, 1, 0x0F, 1, 0x00
    db 1, 0x15, 1, 0x0A, 1, 0x15, 1, 0x0A, 1, 0x15, 1, 0x0A, 1, 0x15, 1, 0x0A
    db 0, 0x80
    db 1, 'D', 1, 'i', 1, 0, 1, 'm', 1, 'e', 1, 't', 1, 'r', 1, 'o', 1, ' '
    db 1, '2', 1, '5', 1, '.', 1, '4', 1, 0xDF
    db 0, 0x80 + 0x40
    db 1, 'A', 1, '/', 1, '\\', 1, 0x7E, 1, 0x09
    db 0xFF, 0xFF
    end
