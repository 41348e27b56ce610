; Program flash of the part store: read, erase, write.
; SPDX-License-Identifier: Apache-2.0
;
; The unlocking sequence 55h, AAh, WR must not be interrupted, so both
; interrupt levels are off for it; the processor stands still while the
; memory works (about 2 ms), and the interrupts that came meanwhile are
; served afterwards. TBLPTRU stays 0, as SDCC expects.

        include <p18f4550.inc>
        radix   dec

        global  _flash_address, _flash_row
        global  _flash_read, _flash_read_u16, _flash_read_i24
        global  _flash_read_u32, _flash_erase_block, _flash_write_row

flash_data      udata
_flash_address  res 2
_flash_row      res 32
saved_intcon    res 1

code_flash      code

; Results as SDCC returns them: WREG, PRODL, PRODH, FSR0L, low byte first.

start_reading macro
        movff   _flash_address, TBLPTRL
        movff   _flash_address + 1, TBLPTRH
        endm

stop_reading macro
        movff   TBLPTRL, _flash_address
        movff   TBLPTRH, _flash_address + 1
        endm

_flash_read:
        start_reading
        tblrd*+
        stop_reading
        movf    TABLAT, W, A
        return

_flash_read_u16:
        start_reading
        tblrd*+
        movf    TABLAT, W, A
        tblrd*+
        movff   TABLAT, PRODL
        stop_reading
        return

_flash_read_u32:
        start_reading
        tblrd*+
        movf    TABLAT, W, A
        tblrd*+
        movff   TABLAT, PRODL
        tblrd*+
        movff   TABLAT, PRODH
        tblrd*+
        movff   TABLAT, FSR0L
        stop_reading
        return

_flash_read_i24:
        start_reading
        tblrd*+
        movf    TABLAT, W, A
        tblrd*+
        movff   TABLAT, PRODL
        tblrd*+
        movff   TABLAT, PRODH
        stop_reading
        clrf    FSR0L, A
        btfsc   PRODH, 7, A
        setf    FSR0L, A
        return

_flash_erase_block:
        rcall   point
        bnc     refused
        movlw   0x94                    ; EEPGD, FREE, WREN
        bra     unlock

_flash_write_row:
        rcall   point
        bnc     refused
        movff   FSR0L, PRODL            ; FSR0 is the caller's
        movff   FSR0H, PRODH
        lfsr    0, _flash_row
        movlw   0x20
copy:
        movff   POSTINC0, TABLAT
        tblwt*+
        decfsz  WREG, W, A
        bra     copy
        movff   PRODL, FSR0L
        movff   PRODH, FSR0H
        tblrd*-                         ; back into the row being written
        movlw   0x84                    ; EEPGD, WREN
unlock:
        clrwdt
        btfsc   EECON1, WR, A           ; the EEPROM may be at it
        bra     unlock
        banksel saved_intcon
        movwf   EECON1, A
        movff   INTCON, saved_intcon
        bcf     INTCON, GIEH, A
        bcf     INTCON, GIEL, A
        movlw   0x55
        movwf   EECON2, A
        movlw   0xAA
        movwf   EECON2, A
        bsf     EECON1, WR, A
        nop
        bcf     EECON1, WREN, A
        btfsc   saved_intcon, GIEL, B
        bsf     INTCON, GIEL, A
        btfsc   saved_intcon, GIEH, B
        bsf     INTCON, GIEH, A
        clrwdt
refused:
        return

; Sets TBLPTR to flash_address; carry set when it lies in the part store.
point:
        banksel _flash_address
        movff   _flash_address, TBLPTRL
        movff   _flash_address + 1, TBLPTRH
        bcf     STATUS, C, A
        btfsc   _flash_address + 1, 7, B
        return
        movlw   0x76
        subwf   _flash_address + 1, W, B
        return
        end
