; SPDX-License-Identifier: Apache-2.0
; Exercises the memories: EEPROM byte 0x21 := 0x5A and back, flash block
; 0x6040 erased and written with 0x80..0x9F, then read back to RAM 0x100.
; RCON and STKPTR as found at reset are left in RAM 0x20 and 0x21, the number
; of starts in 0x22.  RD0 rises when all is done, then the watchdog is fed
; until RAM 0x23 becomes non-zero.

    list p=18f4550
    include <p18f4550.inc>
    config FOSC=HSPLL_HS, PLLDIV=5, CPUDIV=OSC1_PLL2, WDT=ON, WDTPS=16
    config LVP=OFF, PBADEN=OFF, XINST=OFF, STVREN=ON, BOR=ON

saw_rcon equ 0x20
saw_stk  equ 0x21
starts   equ 0x22
starve   equ 0x23
ee_back  equ 0x24
count    equ 0x25

    org 0
    movff RCON, saw_rcon
    movff STKPTR, saw_stk
    incf starts, F, ACCESS
    clrf starve, ACCESS
    clrf STKPTR, ACCESS
    movlw 0x1F
    iorwf RCON, F, ACCESS
    clrf LATD, ACCESS
    movlw 0xF0
    movwf TRISD, ACCESS
    movlw 0x80
    movwf PORTE, ACCESS
; EEPROM
    movlw 0x21
    movwf EEADR, ACCESS
    movlw 0x5A
    movwf EEDATA, ACCESS
    bcf EECON1, EEPGD, ACCESS
    bcf EECON1, CFGS, ACCESS
    rcall unlock
ee_wait
    clrwdt
    btfsc EECON1, WR, ACCESS
    bra ee_wait
    bcf EECON1, WREN, ACCESS
    clrf EEDATA, ACCESS
    bsf EECON1, RD, ACCESS
    movff EEDATA, ee_back
; Flash
    rcall point
    movlw 0x94
    movwf EECON1, ACCESS
    rcall unlock
    rcall point
    movlw .32
    movwf count, ACCESS
fill_latch
    movf count, W, ACCESS
    sublw 0xA0
    movwf TABLAT, ACCESS
    tblwt*+
    decfsz count, F, ACCESS
    bra fill_latch
    tblrd*-
    movlw 0x84
    movwf EECON1, ACCESS
    rcall unlock
    bcf EECON1, WREN, ACCESS
    rcall point
    lfsr 0, 0x100
    movlw .64
    movwf count, ACCESS
back
    tblrd*+
    movff TABLAT, POSTINC0
    decfsz count, F, ACCESS
    bra back
    bsf LATD, 0, ACCESS
feed
    clrwdt
    movf starve, F, ACCESS
    bz feed
starving
    btfss starve, 1, ACCESS
    bra starving
overflow
    rcall overflow

point
    clrf TBLPTRU, ACCESS
    movlw 0x60
    movwf TBLPTRH, ACCESS
    movlw 0x40
    movwf TBLPTRL, ACCESS
    return

unlock
    bsf EECON1, WREN, ACCESS
    movlw 0x55
    movwf EECON2, ACCESS
    movlw 0xAA
    movwf EECON2, ACCESS
    bsf EECON1, WR, ACCESS
    return
    end
