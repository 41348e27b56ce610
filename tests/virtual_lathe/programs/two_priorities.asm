; SPDX-License-Identifier: Apache-2.0
; Step timer and tick as the firmware uses them: CCP2 compares with the free
; running Timer 1 at high priority, every 1000 cycles, without drift; Timer 2
; interrupts at low priority every 241 * 4 * 4 cycles and takes about 200.
; RD0 toggles in the high interrupt, RC0 in the low one.

    list p=18f4550
    include <p18f4550.inc>
    config FOSC=HSPLL_HS, PLLDIV=5, CPUDIV=OSC1_PLL2, WDT=OFF, LVP=OFF
    config PBADEN=OFF, XINST=OFF, CCP2MX=ON

STEP    equ .1000
next_l  equ 0x10
next_h  equ 0x11
save_w  equ 0x14
save_s  equ 0x15
save_b  equ 0x16

    org 0x0000
    goto start
    org 0x0008
    goto high_interrupt
    org 0x0018
    movff WREG, save_w
    movff STATUS, save_s
    movff BSR, save_b
    bcf PIR1, TMR2IF, ACCESS
    btg LATC, 0, ACCESS
    movlw .60
low_wait
    decfsz WREG, W, ACCESS
    bra low_wait
    movff save_b, BSR
    movff save_w, WREG
    movff save_s, STATUS
    retfie

high_interrupt
    bcf PIR2, CCP2IF, ACCESS
    btg LATD, 0, ACCESS
    movlw low STEP
    addwf next_l, F, ACCESS
    movlw high STEP
    addwfc next_h, F, ACCESS
    movff next_h, CCPR2H
    movff next_l, CCPR2L
    retfie FAST

start
    clrf LATD, ACCESS
    clrf TRISD, ACCESS
    clrf LATC, ACCESS
    clrf TRISC, ACCESS
    bsf RCON, IPEN, ACCESS
    movlw 0x0A
    movwf CCP2CON, ACCESS
    movlw high STEP
    movwf next_h, ACCESS
    movwf CCPR2H, ACCESS
    movlw low STEP
    movwf next_l, ACCESS
    movwf CCPR2L, ACCESS
    movlw b'10000001'
    movwf T1CON, ACCESS
    bsf IPR2, CCP2IP, ACCESS
    bsf PIE2, CCP2IE, ACCESS
    movlw .240
    movwf PR2, ACCESS
    movlw b'00011101'
    movwf T2CON, ACCESS
    bcf IPR1, TMR2IP, ACCESS
    bsf PIE1, TMR2IE, ACCESS
    movlw 0xC0
    movwf INTCON, ACCESS
; Registers and flags must survive both interrupts: RC2 rises if they do not.
spin
    movlw 0x5A
    xorlw 0x5A
    bnz broken
    bra spin
broken
    bsf LATC, 2, ACCESS
    bra broken
    end
