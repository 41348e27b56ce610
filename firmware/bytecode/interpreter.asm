; Interpreter of the byte code that modules in no hurry are compiled to.
; SPDX-License-Identifier: Apache-2.0
;
; firmware/toolchain/compile_bytecode.py writes the byte code, with the tables
; at the end of this file's list of externs, and README.md tells why.
;
; a          the accumulator
; PRODH:L    the right side of an operation; after a comparison PRODH has the
;            flags of A - right, Z of all 16 bits
; TBLPTR     next byte of byte code; upper byte 0
; FSR1       the software stack: values pushed, arguments of native functions,
;            return addresses (high byte on top; 0xFF = back to native code)
; resume_at  while an operand comes from the table of pairs, or a native
;            function runs: where the byte code goes on; high byte 0xFF = neither
;
; An operation takes 25 to 45 cycles. Main loop only.

        list    p=18f4550
        include <p18f4550.inc>
        radix   dec

        extern  byte_code               ; functions, offset 0
        extern  byte_pairs              ; operations of two bytes used often
        extern  byte_natives            ; addresses of native functions

        global  byte_enter

; The numbers below are those of bytecode_operations.py.
FIRST_MEMORY    equ     0x50
MEMORY_NUMBER   equ     74              ; of the first one in the table below
FIRST_CALL      equ     0x88
FIRST_PAIR      equ     0xA8

interpreter_data        udata_acs
resume_at       res     2
a               res     2

interpreter_code        code

; From a stub: W, PRODL = address of the function. Returns its A in PRODL, W.
byte_enter:
        movff   resume_at, POSTDEC1
        movff   resume_at + 1, POSTDEC1
        setf    POSTDEC1, ACCESS
        setf    resume_at + 1, ACCESS
        movwf   TBLPTRH, ACCESS
        movff   PRODL, TBLPTRL
        bra     next
leave:
        movff   a + 1, PRODL
        movf    a, W, ACCESS
        movff   PREINC1, resume_at + 1
        movff   PREINC1, resume_at
        return

op_ret1:
        clrf    a + 1, ACCESS
        movlw   1
        movwf   a, ACCESS
        bra     op_ret
op_retk:
        rcall   op_ldk_value
        bra     op_ret
op_ret0:
        clrf    a + 1, ACCESS
        clrf    a, ACCESS
op_ret:
        movf    PREINC1, W, ACCESS
        bn      leave
        movwf   TBLPTRH, ACCESS
        movff   PREINC1, TBLPTRL
        bra     next

; Near the branches that lead here: those reach 128 instructions.
call_function:                          ; W = bits 8 to 12 of the offset
        movwf   PRODL, ACCESS
        rcall   operand
        movff   TBLPTRL, POSTDEC1
        movff   TBLPTRH, POSTDEC1
        addlw   LOW(byte_code)
        movwf   TBLPTRL, ACCESS
        movlw   HIGH(byte_code)
        addwfc  PRODL, W, ACCESS
        movwf   TBLPTRH, ACCESS
        bra     next

memory:                                 ; W = 8 * operation + bits 8 to 10
        movwf   FSR0H, ACCESS
        rrncf   WREG, W, ACCESS
        rrncf   WREG, W, ACCESS
        rrncf   WREG, W, ACCESS
        andlw   0x1F
        addlw   MEMORY_NUMBER
        movwf   PRODL, ACCESS
        movlw   7
        andwf   FSR0H, F, ACCESS
        rcall   operand
        movwf   FSR0L, ACCESS
        movf    PRODL, W, ACCESS
        bra     jump

; An operation of two bytes from the table: its second byte is taken there, by
; operand, which then leads back.
pair:                                   ; W = number of the pair
        movff   TBLPTRL, resume_at
        movff   TBLPTRH, resume_at + 1
        rlncf   WREG, W, ACCESS
        addlw   LOW(byte_pairs)
        movwf   TBLPTRL, ACCESS
        movlw   HIGH(byte_pairs)
        movwf   TBLPTRH, ACCESS
        btfsc   STATUS, C, ACCESS
        incf    TBLPTRH, F, ACCESS
        tblrd   *+
        movf    TABLAT, W, ACCESS
        addlw   -FIRST_PAIR
        bra     execute

op_ld1:
        movlw   1
        bra     byte_result
op_ld0:
        movlw   0
byte_result:                            ; A = W
        movwf   a, ACCESS
        clrf    a + 1, ACCESS

next:
        tblrd   *+
        movlw   FIRST_PAIR
        subwf   TABLAT, W, ACCESS
        bc      pair
execute:                                ; W = operation - FIRST_PAIR
        addlw   FIRST_PAIR - FIRST_CALL
        bc      call_function
        addlw   FIRST_CALL - FIRST_MEMORY
        bc      memory
        addlw   FIRST_MEMORY
jump:                                   ; W = number in the table
        rlncf   WREG, W, ACCESS
        addlw   LOW(operations)
        movwf   PRODL, ACCESS
        movlw   HIGH(operations)
        movwf   PCLATH, ACCESS
        btfsc   STATUS, C, ACCESS
        incf    PCLATH, F, ACCESS
        movf    PRODL, W, ACCESS
        movwf   PCL, ACCESS
operations:
        bra     op_ret
        bra     op_ret0
        bra     op_ret1
        bra     op_ld0
        bra     op_ld1
        bra     op_inc
        bra     op_dec
        bra     op_push
        bra     op_push8
        bra     op_adds
        bra     op_subs
        bra     op_ands
        bra     op_ors
        bra     op_xors
        bra     op_cmps
        bra     op_neg
        bra     op_com
        bra     op_low
        bra     op_ldi8
        bra     op_ldi16
        bra     op_sti8
        bra     op_sti16
        bra     op_clrwdt
        bra     op_shl
        bra     op_shr
        bra     op_sar
        bra     op_ldk
        bra     op_ldkn
        bra     op_addk
        bra     op_addkn
        bra     op_cmpk
        bra     op_retk
        bra     op_andk
        bra     op_ork
        bra     op_xork
        bra     op_ldkw
        bra     op_addkw
        bra     op_cmpkw
        bra     op_andkw
        bra     op_case
        bra     op_jmp
        bra     op_jz
        bra     op_jnz
        bra     op_jeq
        bra     op_jne
        bra     op_jlt
        bra     op_jge
        bra     op_jgt
        bra     op_jle
        bra     op_jltu
        bra     op_jgeu
        bra     op_jgtu
        bra     op_jleu
        bra     op_ljmp
        bra     op_native8
        bra     op_native16
        bra     op_ldt8
        bra     op_ldt16
        bra     op_drop1
        bra     op_drop2
        bra     op_drop3
        bra     op_drop4
        bra     op_add8
        bra     op_sub8
        bra     op_and8
        bra     op_or8
        bra     op_xor8
        bra     op_cmp8
        bra     op_and16
        bra     op_or16
        bra     op_ldx8
        bra     op_ldx16
        bra     op_stx8
        bra     op_stx16
memory_operations:
        bra     op_ld8
        bra     op_ld16
        bra     op_st8
        bra     op_st16
        bra     op_add16
        bra     op_sub16
        bra     op_cmp16

; W, TABLAT = next byte of an operation.
operand:
        tblrd   *+
        btfsc   resume_at + 1, 7, ACCESS
        bra     operand_read
        movff   resume_at + 1, TBLPTRH
        movff   resume_at, TBLPTRL
        setf    resume_at + 1, ACCESS
operand_read:
        movf    TABLAT, W, ACCESS
        return

op_native8:
        rcall   native
        bra     byte_result
op_native16:
        rcall   native
        movwf   a, ACCESS
        movff   PRODL, a + 1
        bra     next
native:
        rcall   operand
        movff   TBLPTRL, resume_at
        movff   TBLPTRH, resume_at + 1
        rlncf   WREG, W, ACCESS
        addlw   LOW(byte_natives)
        movwf   TBLPTRL, ACCESS
        movlw   HIGH(byte_natives)
        movwf   TBLPTRH, ACCESS
        btfsc   STATUS, C, ACCESS
        incf    TBLPTRH, F, ACCESS
        rcall   native_call
go_on:
        movff   resume_at, TBLPTRL
        movff   resume_at + 1, TBLPTRH
        setf    resume_at + 1, ACCESS
        return
native_call:
        tblrd   *+
        movff   TABLAT, PRODL
        tblrd   *+
        movff   TABLAT, PCLATH
        movf    PRODL, W, ACCESS
        movwf   PCL, ACCESS

; --- right sides -----------------------------------------------------------------

small:                                  ; 0 to 255
        rcall   operand
        movwf   PRODL, ACCESS
        clrf    PRODH, ACCESS
        return
negative:                               ; -256 to -1
        rcall   small
        setf    PRODH, ACCESS
        return
wide:
        rcall   small
        rcall   operand
        movwf   PRODH, ACCESS
        return
stacked:
        movff   PREINC1, PRODL
        movff   PREINC1, PRODH
        return
place:                                  ; FSR0 = address of three-byte operations
        rcall   operand
        movwf   FSR0H, ACCESS
        rcall   operand
        movwf   FSR0L, ACCESS
        return
variable8:
        rcall   place
        movff   INDF0, PRODL
        clrf    PRODH, ACCESS
        return
variable16:
        rcall   place
through16:
        movff   POSTINC0, PRODL
        movff   INDF0, PRODH
        return

; --- A and constants -------------------------------------------------------------

op_ldk_value:
        rcall   small
        movff   PRODL, a
        movff   PRODH, a + 1
        return
op_ldkn:
        rcall   negative
        bra     take_right
op_ldkw:
        rcall   wide
        bra     take_right
op_ldk:
        rcall   small
take_right:
        movff   PRODL, a
        movff   PRODH, a + 1
        bra     next

op_push:
        movff   a + 1, POSTDEC1         ; in SDCC's order of arguments
op_push8:
        movff   a, POSTDEC1
        bra     next
op_drop4:
        movf    PREINC1, F, ACCESS
op_drop3:
        movf    PREINC1, F, ACCESS
op_drop2:
        movf    PREINC1, F, ACCESS
op_drop1:
        movf    PREINC1, F, ACCESS
        bra     next

op_com:
        comf    a, F, ACCESS
        comf    a + 1, F, ACCESS
        bra     next
op_neg:
        comf    a, F, ACCESS
        comf    a + 1, F, ACCESS
op_inc:
        infsnz  a, F, ACCESS
        incf    a + 1, F, ACCESS
        bra     next
op_dec:
        movf    a, W, ACCESS
        btfsc   STATUS, Z, ACCESS
        decf    a + 1, F, ACCESS
        decf    a, F, ACCESS
        bra     next
op_low:
        clrf    a + 1, ACCESS
        bra     next
op_clrwdt:
        clrwdt
        bra     next

op_shl:
        rcall   small
shl_once:
        bcf     STATUS, C, ACCESS
        rlcf    a, F, ACCESS
        rlcf    a + 1, F, ACCESS
        decfsz  PRODL, F, ACCESS
        bra     shl_once
        bra     next
op_sar:
        rcall   small
sar_once:
        rlcf    a + 1, W, ACCESS
        rrcf    a + 1, F, ACCESS
        rrcf    a, F, ACCESS
        decfsz  PRODL, F, ACCESS
        bra     sar_once
        bra     next
op_shr:
        rcall   small
shr_once:
        bcf     STATUS, C, ACCESS
        rrcf    a + 1, F, ACCESS
        rrcf    a, F, ACCESS
        decfsz  PRODL, F, ACCESS
        bra     shr_once
        bra     next

; --- A op right ------------------------------------------------------------------

op_addkn:
        rcall   negative
        bra     add
op_addkw:
        rcall   wide
        bra     add
op_addk:
        rcall   small
        bra     add
op_adds:
        rcall   stacked
        bra     add
op_add8:
        rcall   variable8
        bra     add
op_add16:
        rcall   through16
add:
        movf    PRODL, W, ACCESS
        addwf   a, F, ACCESS
        movf    PRODH, W, ACCESS
        addwfc  a + 1, F, ACCESS
        bra     next

op_subs:
        rcall   stacked
        bra     subtract
op_sub8:
        rcall   variable8
        bra     subtract
op_sub16:
        rcall   through16
subtract:
        movf    PRODL, W, ACCESS
        subwf   a, F, ACCESS
        movf    PRODH, W, ACCESS
        subwfb  a + 1, F, ACCESS
        bra     next

op_andk:
        rcall   small
        bra     and_right
op_andkw:
        rcall   wide
        bra     and_right
op_ands:
        rcall   stacked
        bra     and_right
op_and8:
        rcall   variable8
        bra     and_right
op_and16:
        rcall   variable16
and_right:
        movf    PRODL, W, ACCESS
        andwf   a, F, ACCESS
        movf    PRODH, W, ACCESS
        andwf   a + 1, F, ACCESS
        bra     next

op_ork:
        rcall   small
        bra     or_right
op_ors:
        rcall   stacked
        bra     or_right
op_or8:
        rcall   variable8
        bra     or_right
op_or16:
        rcall   variable16
or_right:
        movf    PRODL, W, ACCESS
        iorwf   a, F, ACCESS
        movf    PRODH, W, ACCESS
        iorwf   a + 1, F, ACCESS
        bra     next

op_xork:
        rcall   small
        bra     xor_right
op_xor8:
        rcall   variable8
        bra     xor_right
op_xors:
        rcall   stacked
xor_right:
        movf    PRODL, W, ACCESS
        xorwf   a, F, ACCESS
        movf    PRODH, W, ACCESS
        xorwf   a + 1, F, ACCESS
        bra     next

op_cmpk:
        rcall   small
        bra     compare
op_cmpkw:
        rcall   wide
        bra     compare
op_cmps:
        rcall   stacked
        bra     compare
op_cmp8:
        rcall   variable8
        bra     compare
op_cmp16:
        rcall   through16
compare:
        movf    PRODL, W, ACCESS
        subwf   a, W, ACCESS
        movwf   PRODL, ACCESS
        movf    PRODH, W, ACCESS
        subwfb  a + 1, W, ACCESS
        movff   STATUS, PRODH
        bcf     PRODH, Z, ACCESS
        iorwf   PRODL, W, ACCESS
        btfsc   STATUS, Z, ACCESS
        bsf     PRODH, Z, ACCESS
        bra     next

; --- jumps -----------------------------------------------------------------------

op_case:
        rcall   operand
        xorwf   a, W, ACCESS
        iorwf   a + 1, W, ACCESS
        bra     when_zero
op_jz:
        movf    a, W, ACCESS
        iorwf   a + 1, W, ACCESS
when_zero:
        tblrd   *+
        bz      taken
        bra     next
op_jnz:
        tblrd   *+
        movf    a, W, ACCESS
        iorwf   a + 1, W, ACCESS
        bnz     taken
        bra     next
op_jle:
        btfsc   PRODH, Z, ACCESS
        bra     op_jmp
op_jlt:
        rcall   less
        bc      taken
        bra     next
op_jgt:
        btfsc   PRODH, Z, ACCESS
        bra     not_taken
op_jge:
        rcall   less
        bnc     taken
        bra     next
op_jleu:
        btfsc   PRODH, Z, ACCESS
        bra     op_jmp
op_jltu:
        btfsc   PRODH, C, ACCESS
        bra     not_taken
        bra     op_jmp
op_jgtu:
        btfsc   PRODH, Z, ACCESS
        bra     not_taken
op_jgeu:
        btfsc   PRODH, C, ACCESS
        bra     op_jmp
        bra     not_taken
op_jne:
        btfss   PRODH, Z, ACCESS
        bra     op_jmp
not_taken:
        tblrd   *+
        bra     next
op_jeq:
        btfss   PRODH, Z, ACCESS
        bra     not_taken
op_jmp:
        tblrd   *+
taken:                                  ; TABLAT = distance
        movf    TABLAT, W, ACCESS
        addwf   TBLPTRL, F, ACCESS
        movlw   0
        addwfc  TBLPTRH, F, ACCESS
        btfsc   TABLAT, 7, ACCESS
        decf    TBLPTRH, F, ACCESS
        bra     next
op_ljmp:
        rcall   wide
        movlw   LOW(byte_code)
        addwf   PRODL, W, ACCESS
        movwf   TBLPTRL, ACCESS
        movlw   HIGH(byte_code)
        addwfc  PRODH, W, ACCESS
        movwf   TBLPTRH, ACCESS
        bra     next

; TABLAT = next byte; carry when the comparison said less, signed: N differs
; from OV.
less:
        tblrd   *+
        rrncf   PRODH, W, ACCESS        ; N, bit 4, to bit 3, where OV is
        xorwf   PRODH, W, ACCESS
        andlw   8
        addlw   -8                      ; carry when they differ
        return

; --- variables -------------------------------------------------------------------

op_ldi8:
        rcall   through_a
        bra     op_ld8
op_ldx8:
        rcall   place
        rcall   add_index
op_ld8:
        movff   INDF0, a
        clrf    a + 1, ACCESS
        bra     next
op_ldi16:
        rcall   through_a
        bra     op_ld16
op_ldx16:
        rcall   place
        rcall   add_index
        rcall   add_index
op_ld16:
        movff   POSTINC0, a
        movff   INDF0, a + 1
        bra     next
op_sti8:
        rcall   through_a
        bra     store8
op_stx8:
        rcall   place
        rcall   add_index
store8:
        rcall   stacked
        movff   PRODL, INDF0
        bra     next
op_sti16:
        rcall   through_a
        bra     store16
op_stx16:
        rcall   place
        rcall   add_index
        rcall   add_index
store16:
        rcall   stacked
        movff   PRODL, POSTINC0
        movff   PRODH, INDF0
        bra     next
through_a:
        movff   a, FSR0L
        movff   a + 1, FSR0H
        return
op_st16:
        movff   a, POSTINC0
        movff   a + 1, INDF0
        bra     next
op_st8:
        movff   a, INDF0
        bra     next
add_index:
        movf    a, W, ACCESS
        addwf   FSR0L, F, ACCESS
        movf    a + 1, W, ACCESS
        addwfc  FSR0H, F, ACCESS
        return

; Tables in flash: A = byte or word number A of the table at an address.
op_ldt16:
        rcall   table
        tblrd   *+
        movff   TABLAT, a + 1
        rcall   go_on
        bra     next
op_ldt8:
        rcall   wide
        rcall   table_entry
        clrf    a + 1, ACCESS
        rcall   go_on
        bra     next
table:
        rcall   wide
        movf    a, W, ACCESS
        addwf   PRODL, F, ACCESS
        movf    a + 1, W, ACCESS
        addwfc  PRODH, F, ACCESS
table_entry:                            ; TBLPTR = right + A, behind it in the end
        movff   TBLPTRL, resume_at
        movff   TBLPTRH, resume_at + 1
        movf    PRODL, W, ACCESS
        addwf   a, W, ACCESS
        movwf   TBLPTRL, ACCESS
        movf    PRODH, W, ACCESS
        addwfc  a + 1, W, ACCESS
        movwf   TBLPTRH, ACCESS
        tblrd   *+
        movff   TABLAT, a
        return

        end
