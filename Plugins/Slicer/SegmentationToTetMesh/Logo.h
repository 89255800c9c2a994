// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Logo.h
 * @brief The logo of the module, written by Plugins/Slicer/Icons/draw_icon.py.
 */
#ifndef voxplex_slicer_Logo_h
#define voxplex_slicer_Logo_h

namespace voxplex::slicer
{

inline constexpr int LogoWidth = 64;
inline constexpr int LogoHeight = 64;
inline constexpr int LogoPixelSize = 4;
/** Rows from the top, red, green, blue and opacity; compressed by zlib, in base 64. */
inline constexpr char Logo[] =
  "eNrtm0l01mWWxl3UwkUtauGiFrWoZS26W8uSIfM8J5CBzPNISAgJgQyEMA8BUVEQEVFBQMIoYR5lEJnFsRQUp9KyTnXZ"
  "3Va3fU4tXNy+v5u8X73fP6FaLLX0nMo59xC+fNNz3zs8d3jvuuufP9/Hz8R/eeDnKjUq61U2qaxSWehJ/8jfkWSVu3/k"
  "eH+qkquyOurecTdqJqXI7OpJkh4ZJVOSE+TUMx1yZtNM2fHQ1DDpqMiRkvREyYyO/lJfu3XkPe7+kWD+pcoSlUtFqQlf"
  "LWyZIrseaZLXX+iWG4f75KGuUtm0rE6WzSiSgfYS+Y+Ly0ZJc2GmnHuuw55/YN00md+c73QxqFKBXn+AuO/GfqP+bdxf"
  "VGTrinr7/kGpzE6W117okU9OL7RzfmZJXRj2T88sUtuIH/O1h9a3CPrkM0Z08YsfCPb02F9PuPXQ7FLDdHh9m5RlJI3S"
  "wcXtnVIzKdWwI+8fnyf1eWmyf21rCP/u1c1mG0Hsl3fMssfzEuKkLjfN3icnNvYL7OEfiPsXKrtbSzIN23tH50pxWqLi"
  "WC4fn1pkv/s6eHxuhazrrwzhR357oE/KM5Pl5W2zDH93ba6ds3sN9j+9NMviwfr5VfLW/l5ZMbNYhlRnn55ZrPFksvAd"
  "VO75HnH/RKU3Jzbmy72PTjXcyOv7eqR2cpr8z7WVJkEd1OWmytWdXWH4ER4rTU+S63t6JD8xTt4c6pENC6oMM9gPrGuR"
  "m/p6J+WZSfLhiQXyxZUBk4PrpktaRNTn+p2yv6eYfr6pIF3ePjgnhB0ZfKhRVnaWhvD7OnhiXqX5RBD7Ryfnyyu7u2XL"
  "QL0kjY+QjKhoKVD/X9ZeZDbl40bQMe/jsDtBHzPKc2Qkr/7sOzz3M+SoqVMy5PkHG8LwL20rlGMbZoThR94+MFcSfjPR"
  "8h6+W5AUbzqZHB+r554oNZNTpbMqh7gmGkfs3NfMKR8T/46HG9X+S0bh/8O5JXJS82l+Yjw6+BSu8R1g371loEH+9/qD"
  "8vmF5aN0UJWTYuftcPOd1vVXGd6UCZGG//SmdnlXnxsU4sKc+lwpSk2U948tkOeWN0hDfrrlC18X85sLDCcx5tL2Llnb"
  "VyVNBRlSmJJguYH3mRwfJ9H3jr/2bXIGfa+1D3eVG3Yn6IDYhQ74bpxpEDcx7w21WfjO8Y3t0qh+E8R+4flOs/nXlCOg"
  "A3jRl6+sNPno5ELTBZ+D7eAf04oyJVfzQHftZOMSr+7plg9OzDN5amG1PKs5dfOyBuxg67eEfcmi1qIw7E4+Ob1YStKS"
  "zPbb1f983O8c7JNbx/qV02GzpfLnKytk+YxiPbOKMPzNhRnGkW4cmiNHN7RKl+YAh9/Jn6+ukJbiLDBpjE1Ve+sPYfYF"
  "3bw51GfnsKilkOf3/p3YO8hJ/311peHl3/ePL5Bru3rsPIkFS9uK7XsljpsYhttJr57pmc0zDf+fLiyz+HXymRmG/Zkl"
  "NcaJwe5EeaN88uKiMOzo5BG1v0K1ow0LakwHb+vn+NjRCXbm/I+4oD70FfzkG2LPBhd+WKL5Cd8sURufqufVU5cr8J0N"
  "am99DXmGn/i9eXldGHYEe/jPS8sNP3J9T68UK8bLg7OMz1zf0xWG/zH192eX1ht29NVZpXau/wcPvv6BxvqhNS3m89d2"
  "dYXwH3qiVePDlFH5R3kS3PlXdxrv4u6fcGtSXKy978enFowp556bafGauLRtRaPFRGzAYT+8vlX6GvND2J2sn1dt9jLQ"
  "UWx+7+O/umu22kiyYUf3DjsC3yGf/NflAeNM6JaYCn540YHHp4/KP6/tnaOfFXHjTvIiNehK9dmLz3dZ7HljX+8o7K/u"
  "7bHPv6L85ZHuctn76DTD1lWTKwumFRj+pcpZDz4xPWT7R55sk5mVkyRDsWMz5ZERUhoRIXkx0RbriX+re8rMLogrux5p"
  "DstzC6ZNUZ13Gn4EXy9Vf9q3ptn8itjL88C88+FmiwF8f8XP562+k7P/+NRC9fcVckL9HL5988jcEHZ+x/5OPdMuvz+7"
  "KITf/FWxPqg8qKtmsvE5MM+bWiC5EZHSlRQlg0UJsjwzRprjIqUlPlpuTs82eWVqphyuSpOnCpIkb/xEydJ8Sa7z8ZPv"
  "Dijfc/gR/KEyK8U4RkNeun0mvBE9wp/xrzx9LCMy6ouvUzu6swe7kz2rp5nff3hivgm5aOfDUw17EL+TuY0FEvmvD8iM"
  "hCh5tiBeztemhKR04kQ5UZUilXr+J2rSQzpArjRlKv4JcqQyWSr076tmlVm+Bz++gE047J9rzUA85IyzY2Lk3JaOUbUT"
  "uWVuU77GzzJsYPqdnL0vTy2sldl6psjavsoQduSJeVVh+OEmhdFRMk3Pd11uXBj2Q+VJUqY2f7UxTXYUJ0ljbFQY/vnp"
  "cbJmsvpVQ5pcrE+VJRmxUq3c6u2Dcw07nw32i/oZxIl1/dUaXweMJ6zQeBLEjy2c2Nhm/qr88q3/B39u8Ow/U586qrx2"
  "dXeF8dOs6Gir23z821Y0hPC/c7BfShNi5XxDprw+LVtyx02QY5VJIfzY/oPZcYYfaYqNlKGK1LCzBzf4nQwWJ0pBZKQs"
  "nl4k/epLi5WPYOt8ltM5OoBHWT7x6mZ42YcaH5GZlVYjJN8Ov/LG185u7jR7X6KfRb6rzkmV5e3FWme12u/YYLHmwg0L"
  "qjVPLwzDf0u5a15sjGH/YMYkk8GSFGmKiRhl+w7/vrJkqYmOHHX2vrxUm2qP40/ETeJakCMhQRsgBjypdbPDjx3o6/fd"
  "ro/Be8OzHp9bpXmlQz47u1h57jKTG4f6zd5cvQEfqcpOkTP6PPBvXFQrlcoTjlSlh7A7mZEYY37g274vxMLtqqcpEyba"
  "2YN385QE6U+NkRLVFzligeom7f7xkq5CzqXWHlrTaud+OxuAS5G7HH5E88RXY/WO6F9pTa9+XhPC7MvTi2vDcrHlmRfm"
  "WA+H70P9tqkweRR25Hpzttn1vNToMNtHLtanyTMFCRKlZ1uo+H28O0pT5A31oVttOfZ7m8XSRDv/19SfsUs435o5lfK7"
  "Ec7obGDf2mazdx87sllrBsU6MAb+3WeVp9LDAmsQPzH/1tH5YfiJy+gE7C6f5zwwQYoUA2dZq3Y9KznG7Lo6KtKe064Y"
  "WuKiDCc6KdLnEQOwbfLeq81ZhteXd1pzpECfd7I6VV5pTJdSfS8Xgz46uUD5Yp31UHrr85QXzTYbaCnOtN7Ju5qrj26Y"
  "Lo/2lhs/o+7W73EjiD/q3nFvkdvh0eR7Yq1v+5yzj31obYvFB3Iy+adPbbUzKVquN6WH5MWaVDlUkSI7SpKkIzFaYlRP"
  "3cnRsr88Wc7XpcpV9W1ka2Gi5Un4QVsCnCAc/0BWvMbNOMOOPJ4bL0vaisJiMHJkQ5vMKMs2LmC1Um6q9VO7tFZ8dmmt"
  "1ZrvH+9XThzzl2Deo1/t+jLoALxgDNo+/Av9wLWp/6iDC9VeX23KMAyPTIoP0wFypUF5iZ7tEeU3/OtjR2aqbhxHwEd8"
  "HVxqzDRb4j0cfns//Uw/D9FPxQ6ISeRL8MO7wBuUquG/3+Phvw+793tTNw8Pc7yTT7eb7cPFZpTlmH+8tX9uqAamXidO"
  "gf8Ktqnfa7vmdR//wvRYeXRygryrmNblJZoNOOyXVSZpjjxXkxyWI50OWpVDbFH7cNiDNkD8naN2z3ddNavU+mlvDPVa"
  "fqQ25fveONQXhn+W1pxg9vCXPNpTPqo/9+bQHOs14N/E2wvPzx7VAxjoKJFtRUmGHzlbO3zGx6pSDfuRyhSNBxFyozXb"
  "8CPkO7iPb/s+R3I6qNCcn/mb8YZ1sfKgeWkx0p4YJQ0xkVIeYZzeeP/Q2mny4cn5YYI+iIfUZdjD9T3dIfz00v1+KfFw"
  "76PNIczPP9ho/B3fQY9pEcMzK3z93SPzw/AX6+Ocu8OP7NWcTgy8qHZaExUhByvTQtiRs3UZZtMX6sNt3/HDpRkx+vcJ"
  "knDfOMsLD09KsNyyvyLN8uvlpix5qyVbilWvRYqTHlQQP3pxefH0pplWq519rsPwr1e+6nNh/f0geCvVdzhnOOXVnT1W"
  "y8Cx6E++MdSjcaDG+pXUpYOrpsrr+/r0LCPCsL+smIjTi9TmyQXNGutf05ju40fwB2Imtn+qKlkem0SOiLC8QI48XZNi"
  "/H9FVqzZATk0mFd5/w+0HiFW0Vfy8efGx4VxI3DABXevnmri50D6uvROf+f1XZzA6cBMHnFyaXCW+lqJxN8/QeLuHWd5"
  "m9yFkPOQ+pgos0/4L5jAiWD77Xrm/WmxdrYJ+noeJ4YMqd34vG+yPn5RY+WGvHgpUXsP6gD8fzi32OZm9AYWtU6xOOjO"
  "n/PzsYCvSXMgPSm/P8jvPMbfgjrgPehT+/iRNapvcm6X5vf3NE77Qtzi7LDbFuV2vl9TC+wuSbRzJeeTE3tSojVupI7i"
  "vXkj+JFtRYmmJ59b52tNDX4nA8qH2suzLd4xb+HsgucJvpE++Rnf/51dYCN+XYHAGYLYmXsxjypS2wzi70sl3ifad8Qm"
  "sG9fB3tLEyVL49rD2bGKPVaezE8yO1mX+1fuf0ExY1cOP4LeeOxkbYa9d11aQhh+hFxNvoLrgIPzw5fxaXwbH8fX8XkP"
  "/3RiArGBGDHcV5oZwk+PxcdO/gQ7PZ6KrGSt87JC2DdrnJquucud0YrsBFmdEzsK+5bCBIt1+Ml7ai/Xp2aZLogBB5Qf"
  "HdW8UaexxcePDJUlmV8QB0uS4kbhv3m4X/OexXeL3cZ/FC8xndhOjCfWB/w/m5zg8gO5gpxB7gA/uQTs21bWh2FH6HXt"
  "Kk017Kf1XIjJxGaH/6Lyl8rIiYb9SEWSxXWwO31gH+B3ckhzBfmyUTkxvPhQRfIooR4mLzJT2aScB7z0vslRnDF5n5xF"
  "7naYfSHXk/N9/gMn8DkCPgR34L3QI/NX+s4+doT5JvwUzHzv03UZo+I08Xt7UcIo7Ah27+NH0GPifePtDIkjTho178MV"
  "kNKIYY4L/4CDwUVdTv7o5KJhzqbcjbODy/n4wRXgP/dwrmNxRTgkn4M+TzzdJu8cCu/vX9o+y2y4Q2vcYP13TW36SHW6"
  "1b/RGueezo8fxXOw98tqI+C+oXXOqpwE4wbkVWxjlebCS1oTBwV9UN9Trwc5GXM6V8PB4cmPcHqHH64P5/drAGoC8FIj"
  "UCtQM+A71BDgZwbALIRaB86BvvAr5gAxelbU5tR5TZrv88cP13ZV+h07la8Rt4nz1HD1MRGW611M7NCzxOaPVw9z54Xp"
  "MVYfcNY8Xqi5E5/3sT+lenRzE/5lH8DHDz+hZnP1G7UcNQs6oMaj1huj/r1BnCduUitSM+Lz1JDUkuiCvpv7jM/OLrFZ"
  "BvU2fTHsmJ4F/kkPw8nxymTTRZ3m/RfVrpGB7PiQLjh/6uYytee9pUlyWV+D8Jq31aeOas1EzCcfgJ1/89TPLmzvDM0L"
  "iNd/PL8szPbH6l9g99T41Ppj4B+gNxDsF9BDoJdATwGsQVujDnzhsRbprJykcT4uDDsyW2ti+Pv6vATD7de16ILYANYL"
  "I7gRzh/9UDMgD+bEy1zlR+DHH2xHxpuZbFxULW5G6dt+UOjt0OOh1zPWPgu9IR87vSN6SPSS6CkFbQD+W6+xkT7pH88v"
  "lUrNhVs1vjnsBzS/UQdQr8H18edgX4PHmANszE8I4ccOyKEOP3ZQGRUpTxckSH5M9KiZGQLfoT7DP33bp4dHL4+enpuh"
  "3m4mSG+QHqHDT++QGOP6iUEb4P34TNcr/uD4AsmPjTF/BX9b/HC/ytWs9K+YcTj865X3rFSbcDX+udph/E+ovazQxx1+"
  "5JzmFWIIe4ScN3mHuc/xjdPl/NaZ9i+8jh4tvVp6Y/xOj4ZeLj1derv0eP9G/zvZ75nBBekhO/y+DZzZ1GmzruCcgNlw"
  "cXSU7NQc7c7eyeYpidKnvN/hB/PVpsxQX2CO8mDwY+tbi5JD2E/VpEulxg9yWV9Dvtp3nZ0nuMhP5H5mo5wtsYhePT17"
  "evf+d6O3T4//b80AmBEwK8AOmB0E5wnYAL0gZ2f++5ODL+/olt66PMt39Kx9/PRtctXewbtDORN8z9WD4CQOYvvE/tO1"
  "6Wb32EGZ1h8nnp6hmNoMf3D/Bdmgvu3mM8xqgufCTIfZTjDvjWED05kVMTOyvYQAfmZMMb8eb2eBPtl7wMb4P2fAfIKZ"
  "VVZMjObONIv7G9VvXf+KeLi7LNVqxBcVo18TH9McSB4gHhL3SzQ20tOhpmNXCiHW/+nlZYFeZKvFfDefY1aHvY9x9jVf"
  "Z8eLWSEzQ+ydGSIxAFtgtggXpL8Yr8LMg3m0zefUJ5wce2qGxuhi+feXl6o/dJud5kVFWQ9ng8Y58jxzLx/7m1pDvFSf"
  "YVyKurCa2cLmjhBuJ9S4zFQddvq9xvEC81nyPbPbOzl7TwermRlj4/TamSUzU3azj7KRmTN1ETNoHzvCnIrPBr8TavTn"
  "ltdLwXDtaVyZXsBk9YdiPdNa2wObJAv185L0s/P1MbAGdeD7wFv7+8we8NfgfJ7cxfdnhv91z97D/zN2BsAc3Cdgx4Bd"
  "A3YO2D3g89lF8PFTh4DXx395sMv689Sf7IpkRkUP2+i1FaOE+T8Y9midRj+bOPxId5ntSuILfOatY8M9DnYwbrefwe4G"
  "Oxx3cvaeDn7F7oi/04bAd3hft3fCDgr2B88GOzOhttLsEG7OC05JjKZOoR5nl4a8Qs4mVpNPfPzs+XymtawTalp2JLGR"
  "as1/8FTm3ezesIMDB2cnB78nFtmujvJ1ePBIvs/+hjtA6ewQYWsOP2cb3L9iF4nvxiwewc4HVzVZb4D9F3iyv//Cd4ez"
  "/PZAr3E5dIOeHX441a2j88J0gHCm9HhGMFltyg4Wu1jkXXaz/F0t6hV2uP7OHbBeYgDY8XW+61i7Z+gEHRAbUydG2s7b"
  "+2qjwd2f3ysfg8P43I08g00z0wc/vOLqzu4w3HBXdM+OHTmHnTt2ZPy61xf4MLt739IO4FZ2CtktZMfQYWb3kB1EdhHp"
  "NaAbdhTJRWUaezYtqx+lA3pSxisC/BUOx24zuXt5e4nl+yBuYi/nQDxg55K+NzGOGZSPnV1Ndja/zfsN7JSyW8qOKbum"
  "Lt8zE2DfgxzIjIhdsJsj+/7srrLXhD07Xby0ZZbpK4gfYfcb3SRrfGwtyRqF2+20UXu7vVt0QHxxOqD+GdmJ/8ld3+LP"
  "yP2lT+HY4HS7Vr6wm8yOcnBv2emCOTmvp6aCZ+MHPEaM5kzxAWyHvhZ+BLcI5h92rLF9f/fa6YBYQF/328bu50V2zNk1"
  "93fwnZCP2FEfCz877cyl8Q/yH/GcWR05Pdif433YmUcnwfzDjj279j5+dvHZyWc3//u4H0Q+4c4Bdw/8HXz818dN78Td"
  "3+BOA/adb7yyx2YHt7sPQV6Ea1PjBXVAfxMdO+zcweAuBnH6uzr32+jgHvyMuQt3UeDg8CL6o/RK/3p/Y1rYHSZyEndd"
  "4EzELmbYPn7iCzuk7jW+Dogx/A5ubIoZxIiv/8PuQnEHibtI8G18F+5GTvfrZic8zh0nd9+Ju0/0JuF0Dj/vAzb/degA"
  "n+BuFT0s+A53rr7pbvN3dBdqkLtp5Ab/DpMv9A7gxf6dN+7Aud0D7saRL8Z6LTpgDj9y/63/h3gncuR+EHcUB7mzyN1F"
  "Z//caeRu41h3HrkLiW3AJbgjyfO5MwkvQp8j/epLI3crf/kjuQt698jd1a3ognjAOQfvu3IHlrqAXE/eo59NXuTOLHXo"
  "yHv89K4f8c+ILpK9+839gbvPq0bubq0f+fvP7/rnz/fy83/bwx+U";

} // namespace voxplex::slicer

#endif
