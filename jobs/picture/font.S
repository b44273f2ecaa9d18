// The font of legends, as it is in its file: SEMIGEO_FONT.
    .section .rodata
    .global semigeo_font_begin
    .global semigeo_font_end
    .balign 16
semigeo_font_begin:
    .incbin SEMIGEO_FONT
semigeo_font_end:
    .section .note.GNU-stack, "", @progbits
