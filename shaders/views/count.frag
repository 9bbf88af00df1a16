// views/count.frag: how many surfaces lie in a pixel; drawn with addition.
layout(location = 0) out vec4 oCount;
void main() { oCount = vec4(1.0); }
