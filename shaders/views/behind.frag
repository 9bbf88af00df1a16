// views/behind.frag: nothing; where it is drawn at all, the stencil says.
void main() {}
