; SPDX-License-Identifier: Apache-2.0
; Erases the flash blocks 0x0040 (boot block), 0x0800, 0x2000 and 0x6000, and
; writes zeros over the first rows of them. Boot block and block 1 (0x2000) are
; write-protected. RD0 rises when all is done.

    list p=18f4550
    include <p18f4550.inc>
    config FOSC=HSPLL_HS, PLLDIV=5, CPUDIV=OSC1_PLL2, WDT=OFF
    config LVP=OFF, PBADEN=OFF, XINST=OFF, WRTB=ON, WRT1=ON

count equ 0x20

    org 0
    clrf LATD, ACCESS
    movlw 0xF0
    movwf TRISD, ACCESS
    clrf TBLPTRU, ACCESS
    clrf TBLPTRH, ACCESS
    movlw 0x40
    movwf TBLPTRL, ACCESS
    rcall try
    movlw 0x08
    rcall try_page
    movlw 0x20
    rcall try_page
    movlw 0x60
    rcall try_page
    bsf LATD, 0, ACCESS
    bra $

try_page
    movwf TBLPTRH, ACCESS
    clrf TBLPTRL, ACCESS
try
    movlw 0x94
    rcall unlock
    movlw .32
    movwf count, ACCESS
    clrf TABLAT, ACCESS
fill_latch
    tblwt*+
    decfsz count, F, ACCESS
    bra fill_latch
    tblrd*-
    movlw 0x84
unlock
    movwf EECON1, ACCESS
    movlw 0x55
    movwf EECON2, ACCESS
    movlw 0xAA
    movwf EECON2, ACCESS
    bsf EECON1, WR, ACCESS
    nop
    return

    org 0x0100
    db 1, 2, 3, 4
    org 0x2000
    db 1, 2, 3, 4
    end
